// Nodes at the same place.
#pragma once

#include "core/surface/triangle_surface.hpp"

namespace rouleau::shape {

/// Nodes that lie no farther apart than `distance` become one, at the place of the first of them; triangles that lose a
/// corner so go. Returns how many nodes have gone; none where a triangle has a node that is not there. Throws
/// std::invalid_argument where so many lie together that it would take for ever.
int weld(core::TriangleSurface& surface, double distance);

}  // namespace rouleau::shape
