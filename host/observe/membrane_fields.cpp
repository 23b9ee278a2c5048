#include "membrane_fields.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/solver/in_order.hpp"

namespace rouleau::observe {

namespace {

/// Tensions at the nodes of a cell: of an outline's segments that begin there; of a surface's triangles the means
/// around each node.
std::vector<double> tensions_of(const core::Membranes&, int, std::vector<double> of_segment) { return of_segment; }
std::vector<double> tensions_of(const core::Surfaces& surfaces, int cell, const std::vector<double>& of_triangle) {
  const core::Mesh& mesh = surfaces.type_of(cell).mesh;
  std::vector<double> means;
  for (int i = 0; i < mesh.node_count(); ++i) {
    const auto begin = static_cast<std::size_t>(mesh.corners().first[i]),
               end = static_cast<std::size_t>(mesh.corners().first[i + 1]);
    double sum = 0;
    for (std::size_t c = begin; c < end; ++c) sum += of_triangle[mesh.corners().entry[c] / 3];
    means.push_back(sum / static_cast<double>(end - begin));
  }
  return means;
}

/// The sum of both principal curvatures at each node; 1/m.
void add_curvatures(const core::Surfaces& surfaces, int cell, double spacing, std::vector<double>& values) {
  const core::Mesh& mesh = surfaces.type_of(cell).mesh;
  const std::vector<double> area = core::node_areas(mesh, surfaces.nodes(cell));
  std::size_t i = 0;
  for (const double integral : core::integrated_curvature(mesh, surfaces.nodes(cell)))
    values.push_back(integral / area[i++] / spacing);
}

}  // namespace

template <int D>
MembraneSnapshot observe_membranes(core::AnySolver<D>& solver, const units::LatticeUnits& units) {
  const auto& cells = solver.cells();
  auto* const tasks = solver.cell_tasks();
  MembraneSnapshot snapshot;
  for (const int cell : cells.own_cells()) snapshot.cell.push_back(cell);
  snapshot.cell = core::to_first(solver.ranks(), std::move(snapshot.cell));
  std::sort(snapshot.cell.begin(), snapshot.cell.end());
  snapshot.first.push_back(0);
  for (const int cell : snapshot.cell) snapshot.first.push_back(snapshot.first.back() + cells.cells[cell].count);
  // Adds a field of which add(cell, values) appends those of a cell's nodes.
  const auto field = [&](const char* name, const char* unit, int components, auto add) {
    snapshot.fields.push_back({name, unit, components, [&cells, tasks, add](const Field::Take& take) {
                                 const auto add_known = [&](int cell, std::vector<double>& values) {
                                   if (cells.knows(cell)) add(cell, values);
                                 };
                                 core::give_in_order<double>(
                                     tasks->ghosts(), cells, add_known,
                                     [&](Range, const std::vector<double>& values) { take(values); });
                               }});
  };
  const double spacing = units.length, tension = units.to_si(1, units::dimension::tension);
  field("points", "m", D, [&cells, spacing](int cell, std::vector<double>& values) {
    for (int i = cells.cells[cell].first; i < cells.cells[cell].end(); ++i) {
      for (int k = 0; k < D; ++k) values.push_back(units::coordinate(cells.position[k][i], spacing));
    }
  });
  field("tension", "N/m", 1, [&cells, tasks, tension](int cell, std::vector<double>& values) {
    for (const double of_place : tensions_of(cells, cell, tasks->tensions(cell))) values.push_back(of_place * tension);
  });
  if constexpr (D == 3) {
    field("curvature", "1/m", 1,
          [&cells, spacing](int cell, std::vector<double>& values) { add_curvatures(cells, cell, spacing, values); });
    snapshot.triangles = [&cells](int cell) -> const Triangles& { return cells.type_of(cell).mesh.triangles(); };
  }
  return snapshot;
}

template MembraneSnapshot observe_membranes(core::AnySolver<2>&, const units::LatticeUnits&);
template MembraneSnapshot observe_membranes(core::AnySolver<3>&, const units::LatticeUnits&);

}  // namespace rouleau::observe
