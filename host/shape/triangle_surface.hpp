// Nodes and triangles of a closed surface.
#pragma once

#include <array>
#include <vector>

#include "core/domain/vec.hpp"

namespace rouleau::shape {

/// Nodes around the origin, and triangles counter-clockwise seen from outside.
struct TriangleSurface {
  std::vector<core::Vec<3>> nodes;
  std::vector<std::array<int, 3>> triangles;
};

}  // namespace rouleau::shape
