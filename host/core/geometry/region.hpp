// Where fluid may be: regions, each given by the signed distance to its border.
#pragma once

#include <memory>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/domain/vec.hpp"

namespace rouleau::core {

/// Of a place to the border of a region, in spacings.
template <int D>
struct Distance {
  double value;     ///< positive inside
  Vec<D> gradient;  ///< of the value: a unit vector that points into the region
};

/// A part of space. Places are counted as nodes are: node i along an axis lies at coordinate i.
template <int D>
class Region {
 public:
  virtual ~Region() = default;
  /// Its zero is the border. Elsewhere it is the distance, or less where regions are joined: never more. It is
  /// continuous; where two parts of the border are as near the gradient is that of one of them.
  [[nodiscard]] virtual Distance<D> distance(const Vec<D>& place) const = 0;
  /// Share of the way from a place inside to one outside, `by` away, at which it meets the border: in [0, 1].
  [[nodiscard]] virtual double share_inside(const Vec<D>& place, const Vec<D>& by) const;
  /// Of the border nearest to a place, along which it moves: spacings in any unit of time.
  [[nodiscard]] virtual Vec<D> velocity(const Vec<D>&) const { return Vec<D>::Zero(); }
};

template <int D>
using RegionPointer = std::shared_ptr<const Region<D>>;

/// How a border moves along itself, so that it stays where it is.
template <int D>
struct BorderMotion {
  Vec<D> velocity = Vec<D>::Zero();
  Eigen::Matrix<double, D, D> spin = Eigen::Matrix<double, D, D>::Zero();  ///< gradient of the velocity
  Vec<D> center = Vec<D>::Zero();                                          ///< where the velocity is that

  [[nodiscard]] bool any() const { return !velocity.isZero(0) || !spin.isZero(0); }
};
/// A region with a border that moves.
template <int D>
RegionPointer<D> moving(RegionPointer<D> region, const BorderMotion<D>& motion);

/// All space but a region.
template <int D>
RegionPointer<D> outside_of(RegionPointer<D> region);
/// What lies in each of them, and what lies in any. At least one.
template <int D>
RegionPointer<D> intersection(std::vector<RegionPointer<D>> regions);
template <int D>
RegionPointer<D> union_of(std::vector<RegionPointer<D>> regions);
/// A region `scale` times as large, its origin moved by `shift` after that.
template <int D>
RegionPointer<D> magnified(RegionPointer<D> region, double scale, const Vec<D>& shift);
/// A region with its images along the periodic axes of a domain. It is symmetric about its middle, from where on it is
/// nowhere nearer along any axis: the nearest image is the one with the nearest middle.
template <int D>
RegionPointer<D> repeated(RegionPointer<D> region, const Vec<D>& middle, const Domain<D>& domain);

}  // namespace rouleau::core
