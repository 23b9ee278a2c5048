// Walls that are no planes, as pictures show them.
#pragma once

#include <array>
#include <vector>

#include "scene/scene.hpp"

namespace rouleau::observe {

/// The field of output.fields that is given on walls.
inline constexpr const char* shear_stress = "wall_shear_stress";

/// In m, in the domain's coordinates, and within the domain.
struct WallBorder {
  /// Polygon i around walls, which lie at its left: corners first[i] to first[i + 1] of x and y; in three dimensions
  /// around what the plane across z through the domain's middle cuts of them. They end at the domain's ends.
  std::vector<std::array<double, 2>> corners;
  std::vector<int> first{0};
  /// Sides of these polygons, as numbers of their corners, that fluid meets: not those at the domain's ends.
  std::vector<std::array<int, 2>> segments;
  /// In three dimensions the walls' surface, its triangles counter-clockwise seen from the wall. It is open where the
  /// domain ends.
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> triangles;

  [[nodiscard]] bool empty() const { return corners.empty() && triangles.empty(); }
};

/// Of a scene: straight between samples of the distance to its walls, of polygons a quarter of a spacing apart, of
/// surfaces one; farther where the lattice is large. With wall_shear_stress wanted, sides in
/// two dimensions are at most about a spacing long. Empty where planes alone close the domain.
WallBorder wall_border(const scene::Scene& scene);

/// Of its segments, in three dimensions of its triangles, m.
template <int D>
std::vector<core::Vec<D>> facet_middles(const WallBorder& walls);

}  // namespace rouleau::observe
