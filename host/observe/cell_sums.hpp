// Sums over all cells, to which each owner adds its own: the same bits whoever that is.
#pragma once

#include <array>
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

}  // namespace rouleau::observe
