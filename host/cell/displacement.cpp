#include "displacement.hpp"

#include <algorithm>
#include <cmath>

namespace rouleau::host {

double largest_displacement(const std::vector<double>& x, const std::vector<double>& y,
                            const std::vector<double>& old_x, const std::vector<double>& old_y) {
  double square = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - old_x[i], dy = y[i] - old_y[i];
    square = std::max(square, dx * dx + dy * dy);
  }
  return std::sqrt(square);
}

DisplacementWatch::DisplacementWatch(const Membranes& membranes, double limit)
    : limit_(limit), x_(membranes.x), y_(membranes.y), moved_(membranes.cells.size(), 1) {
  std::fill(x_.begin(), x_.end(), std::nan(""));  // nothing remembered yet: no position is near
}

void DisplacementWatch::measure(Worker worker, const Membranes& membranes) {
  const Range cells = worker.share(static_cast<int>(membranes.cells.size()));
  const double square = limit_ * limit_;
  for (int c = cells.begin; c < cells.end; ++c) {
    const CellRange& cell = membranes.cells[static_cast<std::size_t>(c)];
    const double *x = membranes.x.data(), *y = membranes.y.data(), *old_x = x_.data(), *old_y = y_.data();
    int near = 0;
    for (int i = cell.first; i < cell.end(); ++i) {
      const double dx = x[i] - old_x[i], dy = y[i] - old_y[i];
      near += dx * dx + dy * dy <= square ? 1 : 0;
    }
    moved_[static_cast<std::size_t>(c)] = near != cell.count;
  }
}

bool DisplacementWatch::exceeded() const {
  return std::any_of(moved_.begin(), moved_.end(), [](std::uint8_t moved) { return moved != 0; });
}

void DisplacementWatch::remember(Worker worker, const Membranes& membranes) {
  const Range cells = worker.share(static_cast<int>(membranes.cells.size()));
  for (int c = cells.begin; c < cells.end; ++c) {
    const CellRange& cell = membranes.cells[static_cast<std::size_t>(c)];
    std::copy(membranes.x.begin() + cell.first, membranes.x.begin() + cell.end(), x_.begin() + cell.first);
    std::copy(membranes.y.begin() + cell.first, membranes.y.begin() + cell.end(), y_.begin() + cell.first);
  }
}

}  // namespace rouleau::host
