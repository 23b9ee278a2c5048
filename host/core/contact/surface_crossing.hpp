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
};

/// The deepest node, of those no deeper than three spacings; none: no node lies inside another cell. What crosses within a
/// cell is not looked for.
std::optional<SurfaceCrossing> find_crossing(const Surfaces& surfaces, const Domain<3>& domain);

}  // namespace rouleau::core
