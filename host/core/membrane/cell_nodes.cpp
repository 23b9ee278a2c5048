#include "cell_nodes.hpp"

#include <utility>

namespace rouleau::core {

void CellNodes::reserve(std::size_t cell_count, std::size_t nodes, int dimension) {
  cells.reserve(cell_count);
  for (NodeArrays* arrays : {&position, &force, &velocity})
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) (*arrays)[k].reserve(nodes);
}

void CellNodes::keep_only(std::vector<int> there) {
  part.assign(cells.size(), {.owned = false, .known = false, .reaching = false, .inside = false});
  for (const int c : there) part[c] = {.owned = true, .known = true, .reaching = true, .inside = false};
  known = std::move(there);
}

void CellNodes::resize_to_positions() {
  for (std::size_t k = 0; k < position.size(); ++k)
    for (NodeArrays* arrays : {&force, &velocity}) (*arrays)[k].resize(position[k].size(), 0.0);
}

void CellNodes::remove_cells() {
  cells.clear();
  for (NodeArrays* arrays : {&position, &force, &velocity})
    for (std::vector<double>& values : *arrays) values.clear();
}

std::vector<Range> CellNodes::nodes_in_runs(bool of_known) const {
  std::vector<Range> runs;
  for (int c = 0; c < cell_count(); ++c) {
    if (knows(c) != of_known) continue;
    const CellRange& cell = cells[c];
    if (runs.empty() || runs.back().end != cell.first) runs.push_back({cell.first, cell.first});
    runs.back().end = cell.end();
  }
  return runs;
}

void CellNodes::forget_places(std::span<const Range> nodes) {
  for (std::vector<double>& values : position) release(values, nodes);
}

void CellNodes::forget(std::span<const Range> nodes) {
  forget_places(nodes);
  for (NodeArrays* arrays : {&force, &velocity})
    for (std::vector<double>& values : *arrays) release(values, nodes);
  for (ElementState& of_all : state) release(of_all.value, nodes);
  for (ContactMemory* memory : {&contacts, &wall_contacts}) forget_unknown_of(memory->of_cell);
}

}  // namespace rouleau::core
