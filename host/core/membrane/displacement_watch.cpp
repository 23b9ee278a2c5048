#include "displacement_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace rouleau::core {

double largest_displacement(const CellNodes& cells, std::array<const double*, 3> old, Range nodes) {
  const auto [old_x, old_y, old_z] = old;
  double square = 0, zero = 0;  // zero becomes NaN with the first position that is not finite
  const auto compare = [&](double s) {
    square = s > square ? s : square;
    zero += s - s;
  };
  const auto begin = static_cast<std::size_t>(nodes.begin), end = static_cast<std::size_t>(nodes.end);
  if (cells.z.empty()) {
    for (std::size_t i = begin; i < end; ++i) {
      const double dx = cells.x[i] - old_x[i], dy = cells.y[i] - old_y[i];
      compare(dx * dx + dy * dy);
    }
  } else {
    for (std::size_t i = begin; i < end; ++i) {
      const double dx = cells.x[i] - old_x[i], dy = cells.y[i] - old_y[i], dz = cells.z[i] - old_z[i];
      compare(dx * dx + dy * dy + dz * dz);
    }
  }
  return std::sqrt(square) + zero;
}

DisplacementWatch::Memory::Memory(const CellNodes& cells)
    : x(cells.x.size()),
      y(cells.y.size()),
      z(cells.z.size()),
      limit(cells.cells.size(), 0.0),
      bound(cells.cells.size(), std::numeric_limits<double>::infinity()) {
  for (const int c : cells.known_cells()) {
    for (auto* along : {&x, &y, &z}) {
      if (along->size() > 0) std::fill_n(along->data() + cells.cells[c].first, cells.cells[c].count, std::nan(""));
    }
  }
}

bool DisplacementWatch::Memory::any(const CellNodes& cells) const {
  const CellNumbers known = cells.known_cells();
  return !known.empty() && !std::isnan(x[static_cast<std::size_t>(cells.cells[*known.begin()].first)]);
}

void DisplacementWatch::Memory::exchange_places(CellNodes& cells) {
  for (const int c : cells.known_cells()) {
    const CellRange& cell = cells.cells[c];
    const auto exchange = [&cell](std::vector<double>& now, PagedArray<double>& then) {
      if (!now.empty()) std::swap_ranges(now.begin() + cell.first, now.begin() + cell.end(), then.data() + cell.first);
    };
    exchange(cells.x, x), exchange(cells.y, y), exchange(cells.z, z);
  }
}

DisplacementWatch::DisplacementWatch(const CellNodes& cells) : memory_(cells), moved_(cells.cells.size(), 0) {
  for (const int c : cells.known_cells()) moved_[c] = 1;
}

void DisplacementWatch::forget(const CellNodes& cells, std::span<const Range> nodes) {
  for (auto* places : {&memory_.x, &memory_.y, &memory_.z}) release(*places, nodes);
  cells.forget_unknown_of(moved_);
}

void DisplacementWatch::measure(Worker worker, const CellNodes& nodes) {
  if (agreed_) return;
  const CellNumbers cells = nodes.known_cells(worker);
  for (const int c : cells) {
    measure_cell(c, nodes);
  }
}

bool DisplacementWatch::measure_own(const CellNodes& nodes) {
  bool moved = false;
  for (const int c : nodes.own_cells()) {
    measure_cell(c, nodes);
    moved = moved || moved_[c] != 0;
  }
  return moved;
}

void DisplacementWatch::measure_cell(int cell, const CellNodes& nodes) {
  double& bound = memory_.bound[cell];
  bound = nodes.largest_step.empty() ? std::numeric_limits<double>::infinity() : bound + nodes.largest_step[cell];
  if (!(bound <= memory_.limit[cell])) {
    const CellRange& range = nodes.cells[cell];
    bound =
        largest_displacement(nodes, {memory_.x.data(), memory_.y.data(), memory_.z.data()}, {range.first, range.end()});
  }
  moved_[cell] = !(bound <= memory_.limit[cell]);
}

bool DisplacementWatch::exceeded() const {
  if (agreed_) return *agreed_;
  return !moved_.empty() && std::memchr(moved_.data(), 1, moved_.size()) != nullptr;
}

void DisplacementWatch::remember(int cell, const CellNodes& nodes, double limit) {
  const CellRange& range = nodes.cells[cell];
  const auto copy = [&range](const std::vector<double>& from, PagedArray<double>& to) {
    std::copy(from.begin() + range.first, from.begin() + range.end(), to.data() + range.first);
  };
  copy(nodes.x, memory_.x);
  copy(nodes.y, memory_.y);
  if (!nodes.z.empty()) copy(nodes.z, memory_.z);
  memory_.limit[cell] = limit;
  memory_.bound[cell] = 0;
}

}  // namespace rouleau::core
