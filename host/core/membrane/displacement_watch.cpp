#include "displacement_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace rouleau::core {

namespace {

template <int D>
double farthest(const std::array<const double*, D>& now, const std::array<const double*, 3>& old, Range nodes) {
  double square = 0, zero = 0;  // zero becomes NaN with the first position that is not finite
  for (int i = nodes.begin; i < nodes.end; ++i) {
    double s = 0;
    for (int k = 0; k < D; ++k) s += (now[k][i] - old[k][i]) * (now[k][i] - old[k][i]);
    square = s > square ? s : square;
    zero += s - s;
  }
  return std::sqrt(square) + zero;
}

}  // namespace

double largest_displacement(const CellNodes& cells, std::array<const double*, 3> old, Range nodes) {
  if (cells.position[2].empty()) return farthest<2>(pointers<2>(cells.position), old, nodes);
  return farthest<3>(pointers<3>(cells.position), old, nodes);
}

DisplacementWatch::Memory::Memory(const CellNodes& cells)
    : limit(cells.cells.size(), 0.0), bound(cells.cells.size(), std::numeric_limits<double>::infinity()) {
  for (std::size_t k = 0; k < position.size() && !cells.position[k].empty(); ++k) {
    position[k] = PagedArray<double>(cells.position[k].size());
    for (const int c : cells.known_cells())
      std::fill_n(position[k].data() + cells.cells[c].first, cells.cells[c].count, std::nan(""));
  }
}

bool DisplacementWatch::Memory::any(const CellNodes& cells) const {
  const CellNumbers known = cells.known_cells();
  return !known.empty() && !std::isnan(position[0][static_cast<std::size_t>(cells.cells[*known.begin()].first)]);
}

void DisplacementWatch::Memory::exchange_places(CellNodes& cells) {
  for (const int c : cells.known_cells()) {
    const CellRange& cell = cells.cells[c];
    for (std::size_t k = 0; k < position.size() && !cells.position[k].empty(); ++k) {
      const auto now = cells.position[k].begin();
      std::swap_ranges(now + cell.first, now + cell.end(), position[k].data() + cell.first);
    }
  }
}

DisplacementWatch::DisplacementWatch(const CellNodes& cells) : memory_(cells), moved_(cells.cells.size(), 0) {
  for (const int c : cells.known_cells()) moved_[c] = 1;
}

void DisplacementWatch::forget(const CellNodes& cells, std::span<const Range> nodes) {
  for (PagedArray<double>& along : memory_.position) release(along, nodes);
  cells.forget_unknown_of(moved_);
}

void DisplacementWatch::measure(Worker worker, const CellNodes& nodes) {
  if (agreed_) return;
  const CellNumbers cells = nodes.known_cells(worker);
  for (const int c : cells) measure_cell(c, nodes);
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
    bound = largest_displacement(nodes, pointers<3>(std::as_const(memory_.position)), {range.first, range.end()});
  }
  moved_[cell] = !(bound <= memory_.limit[cell]);
}

bool DisplacementWatch::exceeded() const {
  if (agreed_) return *agreed_;
  return !moved_.empty() && std::memchr(moved_.data(), 1, moved_.size()) != nullptr;
}

void DisplacementWatch::remember(int cell, const CellNodes& nodes, double limit) {
  const CellRange& range = nodes.cells[cell];
  for (std::size_t k = 0; k < nodes.position.size() && !nodes.position[k].empty(); ++k) {
    const auto now = nodes.position[k].begin();
    std::copy(now + range.first, now + range.end(), memory_.position[k].data() + range.first);
  }
  memory_.limit[cell] = limit;
  memory_.bound[cell] = 0;
}

}  // namespace rouleau::core
