// The border of what is positive among samples on a grid.
#pragma once

#include <array>
#include <vector>

#include "border.hpp"

namespace rouleau::core {

/// Where samples, one spacing apart, change their sign: linear along edges and diagonals of the grid, of second order
/// in its spacing. Each square is cut into two triangles, each cube into six tetrahedra (Kuhn's), so that borders have
/// no holes; they end where the grid does. `samples`: the first axis is the fastest; sample 0 lies at the origin. Zero
/// counts as negative. Throws std::invalid_argument where `samples` is not as long as the grid.
template <int D>
Border<D> zero_border(const std::vector<double>& samples, const std::array<int, D>& size);

}  // namespace rouleau::core
