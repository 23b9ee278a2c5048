// Borders made of facets: polygons in two dimensions, surfaces of triangles in three.
#pragma once

#include <array>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/domain/vec.hpp"
#include "region.hpp"

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

/// Where samples, one spacing apart, change their sign: linear along edges and diagonals of the grid, of second order
/// in its spacing. Each square is cut into two triangles, each cube into six tetrahedra (Kuhn's), so that borders have
/// no holes; they end where the grid does. `samples`: the first axis is the fastest; sample 0 lies at the origin. Zero
/// counts as negative. Throws std::invalid_argument where `samples` is not as long as the grid.
template <int D>
Border<D> zero_border(const std::vector<double>& samples, const std::array<int, D>& size);

/// The border of a region in a domain, over one period along periodic axes, else from half a spacing before the first
/// node to half a spacing behind the last: of second order in the spacing, edges rounded within one. Looks at the
/// region near its border alone. Corners are those of blocks, which do not share them.
template <int D>
Border<D> border_of_region(const Region<D>& region, const Domain<D>& domain);

/// Length or area of a facet.
template <int D>
double size_of(const Border<D>& border, const std::array<int, D>& facet) {
  return border.normal(facet).norm() / (D - 1);
}
/// Of a whole border.
template <int D>
double size_of(const Border<D>& border) {
  double sum = 0;
  for (const std::array<int, D>& facet : border.facets) sum += size_of<D>(border, facet);
  return sum;
}

}  // namespace rouleau::core
