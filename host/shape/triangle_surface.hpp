// Nodes and triangles of a closed surface.
#pragma once

#include <array>
#include <vector>

#include "core/surface/surfaces.hpp"

namespace rouleau::shape {

/// Nodes around the origin, and triangles counter-clockwise seen from outside.
struct TriangleSurface {
  std::vector<core::Vec<3>> nodes;
  std::vector<std::array<int, 3>> triangles;
};

/// The surface at rest; `prestretch`: lengths as given over those at rest.
core::RestSurface rest_surface(const TriangleSurface& surface, double prestretch = 1);

}  // namespace rouleau::shape
