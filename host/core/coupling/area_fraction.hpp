// How much of each lattice node's unit square lies inside a cell.
#pragma once

#include <vector>

#include "core/membrane/membranes.hpp"

namespace rouleau::core {

/// Values on the box around one cell, not wrapped into the lattice. Two nodes on every side are zero before smoothing.
struct AreaFraction {
  int x0 = 0, y0 = 0, width = 0,
      height = 0;               ///< element (i, j) is lattice node (x0 + i, y0 + j); no size: nothing covered
  std::vector<double> value;    ///< [height][width]
  std::vector<int> begin, end;  ///< [height]: elements of the row outside which all values are exactly zero

  [[nodiscard]] const double* row(int j) const { return value.data() + static_cast<std::size_t>(j) * width; }
  [[nodiscard]] double* row(int j) { return value.data() + static_cast<std::size_t>(j) * width; }
};

/// Exact fraction, as the sum of signed areas to the right of the edges: 1 inside, and where an outline overlaps itself
/// twice, 2. The sum of all values is the enclosed area.
void cover(const Membranes& membranes, const CellRange& cell, AreaFraction& fraction);

/// One pass of (1 2 1)/4 along x and along y; keeps the sum.
void smooth(AreaFraction& fraction, std::vector<double>& scratch);

}  // namespace rouleau::core
