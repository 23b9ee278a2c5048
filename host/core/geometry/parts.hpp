// Parts of a domain inside and outside of a region.
#pragma once

#include <vector>

#include "region.hpp"

namespace rouleau::core {

/// Area or volume of a region in a box, given by its middle and half its sides: from parts that are halves of halves so
/// many times, of which those at the border count by the share that a plane would leave of them.
template <int D>
double content_of(const Region<D>& region, const Vec<D>& middle, const Vec<D>& half, int halvings);

/// Of each connected piece of a domain's nodes that lie outside of a region, or on its border, the one that lies
/// deepest. Nodes are connected along axes.
template <int D>
std::vector<Vec<D>> pieces_outside(const Region<D>& region, const Domain<D>& domain);

}  // namespace rouleau::core
