// Sums and extremes over all cells, to which each owner adds its own: the same bits whoever that is.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/domain/ranks.hpp"
#include "core/membrane/cell_nodes.hpp"

namespace rouleau::observe {

/// Each of the sums of what shares(cell), a std::array<double, count>, gives of every rank's cells. All ranks ask
/// together.
template <std::size_t count, int D, class Shares>
std::array<double, count> sums_over(const core::CellNodes& cells, const core::Ranks<D>& ranks, Shares shares) {
  std::vector<core::ExactSum> sums(count);
  for (const int c : cells.own_cells()) {
    const std::array<double, count> of_cell = shares(c);
    for (std::size_t k = 0; k < count; ++k) sums[k].add(of_cell[k]);
  }
  core::add_up(ranks, sums);
  std::array<double, count> values;
  for (std::size_t k = 0; k < count; ++k) values[k] = sums[k].value();
  return values;
}

/// The sum of share(cell), a number.
template <int D, class Share>
double sum_over(const core::CellNodes& cells, const core::Ranks<D>& ranks, Share share) {
  return sums_over<1>(cells, ranks, [&](int c) { return std::array<double, 1>{share(c)}; }).front();
}

/// The change of a cell that is the largest: one that is no number above all, of these the last cell's, as of equal
/// ones the first one's.
struct Change {
  double share = 0;
  int cell = -1;
};
inline bool larger(const Change& a, const Change& b) {
  const bool finite_a = std::isfinite(a.share), finite_b = std::isfinite(b.share);
  if (!finite_a || !finite_b) return !finite_a && (finite_b || a.cell > b.cell);
  return a.share != b.share ? a.share > b.share : a.cell >= 0 && (b.cell < 0 || a.cell < b.cell);
}
/// Of all ranks' cells, each change(cell).
template <int D, class ChangeOf>
Change largest_change(const core::CellNodes& cells, const core::Ranks<D>& ranks, ChangeOf change) {
  Change largest;
  for (const int c : cells.own_cells()) {
    const Change here{std::abs(change(c)), c};
    if (here.share != 0 && larger(here, largest)) largest = here;
  }
  return core::best_of_all(ranks, largest, larger);
}

}  // namespace rouleau::observe
