#include "cell_nodes.hpp"

namespace rouleau::core {

void CellNodes::reserve(std::size_t cell_count, std::size_t nodes, int dimension) {
  cells.reserve(cell_count);
  for (auto* values : {&x, &y, &force_x, &force_y, &velocity_x, &velocity_y}) values->reserve(nodes);
  for (auto* values : {&z, &force_z, &velocity_z}) {
    if (dimension == 3) values->reserve(nodes);
  }
}

void CellNodes::remove_cells() {
  cells.clear();
  for (auto* values : {&x, &y, &z, &force_x, &force_y, &force_z, &velocity_x, &velocity_y, &velocity_z})
    values->clear();
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
  for (auto* values : {&x, &y, &z}) release(*values, nodes);
}

void CellNodes::forget(std::span<const Range> nodes) {
  forget_places(nodes);
  for (auto* values : {&force_x, &force_y, &force_z, &velocity_x, &velocity_y, &velocity_z}) release(*values, nodes);
  for (ElementState& of_all : state) release(of_all.value, nodes);
  for (ContactMemory* memory : {&contacts, &wall_contacts}) forget_unknown_of(memory->of_cell);
}

}  // namespace rouleau::core
