// Distances between surfaces at one instant, where lists of candidates would not be used again.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "closest_points.hpp"
#include "core/domain/images.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

/// Calls visit(ImageShift, moved) for each image of box `b`, moved by whole periods, that comes within `reach` of box `a`.
template <class Visit>
void for_each_image(const BoundingBox<3>& a, const BoundingBox<3>& b, double reach, const Domain<3>& domain,
                    Visit visit) {
  std::array<int, 3> first{}, last{};
  for (int k = 0; k < 3; ++k) {
    const double low = a.least[k] - b.most[k] - reach, high = a.most[k] - b.least[k] + reach;
    if (domain.periodic[k]) {
      first[k] = static_cast<int>(std::ceil(low / domain.period(k)));
      last[k] = static_cast<int>(std::floor(high / domain.period(k)));
    } else if (low > 0 || high < 0) {
      return;
    }
  }
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x)
        visit(ImageShift{x, y, z}, Vec<3>(x * domain.period(0), y * domain.period(1), z * domain.period(2)));
    }
  }
}

/// Surfaces in patches, of nodes and of triangles that follow each other and so lie side by side in most meshes, with a
/// box around each: only where boxes come nearer than what has been found are the points themselves looked at.
/// Distances are those of SurfaceContacts, to the bit.
class SurfacePatches {
 public:
  /// Both outlive this, and nothing moves meanwhile. Of cells that are not known nothing is asked.
  SurfacePatches(const Surfaces& surfaces, const Domain<3>& domain)
      : surfaces_(surfaces), domain_(domain), cells_(surfaces.cells.size()) {}

  struct Point {
    double square;  ///< of the distance
    int triangle;   ///< of equally near ones the first
    std::array<double, 3> weight;
    Vec<3> away;  ///< from the closest point to the place
  };
  /// The point of a cell's surface closest to a place, if it lies within `most`.
  std::optional<Point> closest(const Vec<3>& place, int cell, double most);
  /// The smallest distance between a cell and any image of the others, itself among them, from the nodes of either to the
  /// surface of the other, if it is not more than `most`; else infinite. `boxes`: of all cells.
  double gap(int cell, std::span<const int> others, const std::vector<BoundingBox<3>>& boxes, double most);

 private:
  using Box = Eigen::AlignedBox3d;
  struct Patches {
    std::vector<Box> nodes, triangles;
  };
  static constexpr int size = 16;  // of a patch
  const Patches& of(int cell);
  /// Lowers `square` to that of the smallest distance of the nodes of one cell from the surface of another, moved.
  void lower(double& square, int from, int to, const Vec<3>& moved);
  void look(double& square, int from, int nodes, int to, int triangles, const Vec<3>& moved);

  const Surfaces& surfaces_;
  const Domain<3>& domain_;
  std::vector<Patches> cells_;
  ClosestPoints points_;
  struct Near {
    double square;
    int nodes, triangles;
  };
  std::vector<Near> near_;
};

}  // namespace rouleau::core
