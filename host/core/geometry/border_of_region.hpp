// The border of a region as facets, found on the lattice.
#pragma once

#include "border.hpp"
#include "region.hpp"

namespace rouleau::core {

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
