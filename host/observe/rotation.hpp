// How aggregates are turned: the angle of the line through the two outermost cells of each, followed over time.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "aggregates.hpp"
#include "json/json.hpp"
#include "snapshot.hpp"

namespace rouleau::observe {

class Rotation {
 public:
  /// Angle of the line through the two cells of each aggregate that lie farthest apart, rad, counter-clockwise against
  /// x, by the aggregate's label. The cells are brought together through the images by which their contacts join them
  /// (spacings, like `centers`, which are those of aggregates.cells). A line has no direction: the angle lies in
  /// (-pi/2, pi/2] when the aggregate is new, and is then continued by whole half turns as long as it has the same
  /// members. Lone cells have none, nor has an aggregate that is closed to a ring through the periodic border: it has
  /// no ends.
  std::map<int, double> follow(const std::vector<CellContact>& contacts, const Aggregates& aggregates,
                               const std::vector<Eigen::Vector2d>& centers, const core::Domain<2>& domain);
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Rotation, last_)

 private:
  std::map<std::vector<int>, double> last_;  ///< by members
};

/// Rotation of the aggregate with the most cells (of equal ones the first), rad; NaN when it has none.
double largest_rotation(const Snapshot& snapshot);

}  // namespace rouleau::observe
