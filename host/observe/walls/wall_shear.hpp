// Shear stress on walls of any shape.
#pragma once

#include <cstddef>
#include <vector>

#include "core/fluid/any_fluid.hpp"
#include "core/geometry/region.hpp"

namespace rouleau::observe {

/// The fluid's shear stress on walls, at places beside them. About a place the viscous stress of the fluid's nodes
/// within three spacings on its side of the wall is fitted by a quadratic polynomial (least squares; nodes count less
/// far from the place, and beside the wall, where links cut short spoil their stress). Where nodes are few a linear one
/// or their mean is taken. What that comes to is a sum of nodes' stresses, made once.
template <int D>
class WallShear {
 public:
  /// Nothing is known of any place.
  WallShear() = default;
  /// The places move to the nearest wall of the region. Lattice units.
  WallShear(const core::Region<D>& region, const core::Domain<D>& domain, const core::SolidNodes<D>& solid,
            const std::vector<core::Vec<D>>& places);
  /// Force on the wall along it, per area, of each place; of a fluid that is settled. All ranks together; on the first
  /// one.
  [[nodiscard]] std::vector<core::Vec<D>> of(const core::AnyFluid<D>& fluid) const;

 private:
  struct Term {
    std::size_t node;  ///< of the lattice, row after row
    int place;
    float share;
  };
  std::vector<Term> terms_;            ///< by node
  std::vector<core::Vec<D>> normals_;  ///< of the places, into the fluid
};

}  // namespace rouleau::observe
