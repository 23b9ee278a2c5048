// How much of each lattice node's unit square, or cube, lies inside a cell.
#pragma once

#include <array>
#include <vector>

#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

/// Values on the box around one cell, not wrapped into the lattice. Two nodes on every side are zero before smoothing.
template <int D>
struct CellFraction {
  std::array<int, D> first{};   ///< element 0 is this node of the lattice
  std::array<int, D> size{};    ///< no size: nothing covered
  std::vector<double> value;    ///< x is the fastest index
  std::vector<int> begin, end;  ///< of each row: elements outside which all values are zero

  [[nodiscard]] int row_count() const { return static_cast<int>(begin.size()); }
  /// Row i of those along x, y the faster index.
  [[nodiscard]] const double* row(int i) const { return value.data() + static_cast<std::size_t>(i) * size[0]; }
  [[nodiscard]] double* row(int i) { return value.data() + static_cast<std::size_t>(i) * size[0]; }
};

/// Makes it zero on the box around a cell; false: nothing is covered, as where a run is about to end.
template <int D>
bool clear_around(const BoundingBox<D>& box, CellFraction<D>& fraction);

/// Exact fraction, as the sum of signed areas to the right of the edges: 1 inside, and where an outline overlaps itself
/// twice, 2. The sum of all values is the enclosed area.
void cover(const Membranes& membranes, int cell, CellFraction<2>& fraction);

/// The fraction along four lines through each cube, parallel to x, of which it is the mean: exact along them, so that
/// the sum of all values is the enclosed volume up to an error of second order. Where a surface overlaps itself twice
/// it is 2.
void cover(const Surfaces& surfaces, int cell, CellFraction<3>& fraction);

/// One pass of (1 2 1)/4 along each axis; keeps the sum.
template <int D>
void smooth(CellFraction<D>& fraction, std::vector<double>& scratch);

}  // namespace rouleau::core
