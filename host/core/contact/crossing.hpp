// Finds membranes that cross: a cell through itself, through another, or inside another.
#pragma once

#include <optional>

#include "core/domain/domain.hpp"
#include "core/domain/images.hpp"
#include "core/domain/vec.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

struct Crossing {
  int cell, other;   ///< indices into Membranes::cells; equal: with itself or its own image
  ImageShift shift;  ///< of `other`
  int node;          ///< index in Membranes: first node of the crossing segment of `cell`, or the node inside
  Vec<2> place;      ///< where, in lattice units near `cell`
  bool inside;       ///< the outlines do not cross, but `cell` lies inside `other`
};

/// The first crossing in order of cells, or none, of pairs whose first cell is this rank's and whose second one it
/// knows. Outlines that only touch do not cross.
std::optional<Crossing> find_crossing(const Membranes& membranes, const Domain<2>& domain);

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
