#include "displacement_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rouleau::core {

double largest_displacement(const std::vector<double>& x, const std::vector<double>& y,
                            const std::vector<double>& old_x, const std::vector<double>& old_y, Range nodes) {
  double square = 0, zero = 0;  // zero becomes NaN with the first position that is not finite
  for (auto i = static_cast<std::size_t>(nodes.begin); i < static_cast<std::size_t>(nodes.end); ++i) {
    const double dx = x[i] - old_x[i], dy = y[i] - old_y[i], s = dx * dx + dy * dy;
    square = s > square ? s : square;
    zero += s - s;
  }
  return std::sqrt(square) + zero;
}

DisplacementWatch::DisplacementWatch(const Membranes& membranes)
    : memory_{std::vector<double>(membranes.x.size(), std::nan("")),
              std::vector<double>(membranes.y.size(), std::nan("")), std::vector<double>(membranes.cells.size(), 0.0),
              std::vector<double>(membranes.cells.size(), std::numeric_limits<double>::infinity())},
      moved_(membranes.cells.size(), 1) {}

void DisplacementWatch::measure(Worker worker, const Membranes& membranes) {
  const Range cells = worker.share(membranes.cell_count());
  const bool unknown = membranes.largest_step.empty();
  for (int c = cells.begin; c < cells.end; ++c) {
    const auto at = static_cast<std::size_t>(c);
    double& bound = memory_.bound[at];
    bound = unknown ? std::numeric_limits<double>::infinity() : bound + membranes.largest_step[at];
    if (!(bound <= memory_.limit[at])) {
      const CellRange& cell = membranes.cells[at];
      bound = largest_displacement(membranes.x, membranes.y, memory_.x, memory_.y, {cell.first, cell.end()});
    }
    moved_[at] = !(bound <= memory_.limit[at]);
  }
}

bool DisplacementWatch::exceeded() const {
  return std::any_of(moved_.begin(), moved_.end(), [](std::uint8_t moved) { return moved != 0; });
}

void DisplacementWatch::remember(int cell, const Membranes& membranes, double limit) {
  const CellRange& range = membranes.cells[cell];
  std::copy(membranes.x.begin() + range.first, membranes.x.begin() + range.end(), memory_.x.begin() + range.first);
  std::copy(membranes.y.begin() + range.first, membranes.y.begin() + range.end(), memory_.y.begin() + range.first);
  memory_.limit[cell] = limit;
  memory_.bound[cell] = 0;
}

}  // namespace rouleau::core
