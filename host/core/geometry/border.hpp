// Borders made of facets: polygons in two dimensions, surfaces of triangles in three.
#pragma once

#include <array>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/domain/vec.hpp"

namespace rouleau::core {

/// Facets are segments in the plane, with the region at their left; triangles in space, counter-clockwise seen from
/// outside of the region.
template <int D>
struct Border {
  std::vector<Vec<D>> corners;
  std::vector<std::array<int, D>> facets;  ///< numbers of their corners

  /// Outward, as long as the segment, or twice the triangle's area.
  [[nodiscard]] Vec<D> normal(const std::array<int, D>& facet) const;
};

/// A border in a domain that comes again along its periodic axes, from half a spacing before the first node to half a
/// spacing behind the last: with its images one period away. Of what passes along such an axis from end to end, the
/// facets at or beyond the ends go: these are no border.
template <int D>
Border<D> with_images(Border<D> border, const Domain<D>& domain);

/// Middles of the sides of facets (corners in the plane, edges in space) that are not joined to one other facet,
/// running the other way: none of a closed border.
template <int D>
std::vector<Vec<D>> open_sides(const Border<D>& border);

}  // namespace rouleau::core
