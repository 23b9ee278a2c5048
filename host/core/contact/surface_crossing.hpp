// Finds surfaces that have gone through each other.
#pragma once

#include <optional>

#include "core/domain/domain.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

struct SurfaceCrossing {
  int cell, other;  ///< a node of `cell` lies inside `other`, or inside an image of it
  int node;         ///< index in Surfaces
  double depth;     ///< spacings

  static constexpr double deepest = 3;  ///< that is looked for
};

/// The deepest node of this rank's cells; none: no node lies inside another cell that it knows. What crosses within a
/// cell is not looked for.
std::optional<SurfaceCrossing> find_crossing(const Surfaces& surfaces, const Domain<3>& domain);

}  // namespace rouleau::core
