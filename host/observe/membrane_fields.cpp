#include "membrane_fields.hpp"

#include <type_traits>

#include "core/solver/in_order.hpp"

namespace rouleau::observe {

namespace {

/// Appends the tension of each segment of a cell, or the mean over the triangles around each node of a surface; N/m.
template <class T>
void add_tensions(core::OutlineTasks<T>& tasks, const core::Membranes& membranes, int cell, double unit,
                  std::vector<double>& values) {
  for (const double tension : tasks.forces().tensions(membranes, cell)) values.push_back(tension * unit);
}
template <class T>
void add_tensions(core::SurfaceTasks<T>& tasks, const core::Surfaces& surfaces, int cell, double unit,
                  std::vector<double>& values) {
  const core::Mesh& mesh = surfaces.type_of(cell).mesh;
  const std::vector<double> of_triangle = tasks.forces().tensions(surfaces, cell);
  for (int i = 0; i < mesh.node_count(); ++i) {
    const auto begin = static_cast<std::size_t>(mesh.corners().first[i]),
               end = static_cast<std::size_t>(mesh.corners().first[i + 1]);
    double sum = 0;
    for (std::size_t c = begin; c < end; ++c) sum += of_triangle[mesh.corners().entry[c] / 3];
    values.push_back(sum / static_cast<double>(end - begin) * unit);
  }
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

template <class T, class Set>
MembraneSnapshot observe_membranes(core::Solver<T, Set>& solver, const units::LatticeUnits& units) {
  constexpr bool in_space = Set::dimension == 3;
  const auto& cells = solver.cells();
  auto* const tasks = solver.cell_tasks();
  MembraneSnapshot snapshot;
  for (const core::CellRange& cell : cells.cells) snapshot.first.push_back(cell.first);
  snapshot.first.push_back(cells.node_count());
  // Adds a field of which add(cell, values) appends those of a cell's nodes.
  const auto field = [&](const char* name, const char* unit, int components, auto add) {
    snapshot.fields.push_back({name, unit, components, [&cells, tasks, add](const Field::Take& take) {
                                 core::give_in_order<double>(
                                     tasks->ghosts(), cells, add,
                                     [&](Range, const std::vector<double>& values) { take(values); });
                               }});
  };
  const double spacing = units.length, tension = units.to_si(1, units::dimension::tension);
  field("points", "m", Set::dimension, [&cells, spacing](int cell, std::vector<double>& values) {
    for (int i = cells.cells[cell].first; i < cells.cells[cell].end(); ++i) {
      values.push_back(units::coordinate(cells.position[0][i], spacing));
      values.push_back(units::coordinate(cells.position[1][i], spacing));
      if (in_space) values.push_back(units::coordinate(cells.position[2][i], spacing));
    }
  });
  field("tension", "N/m", 1, [&cells, tasks, tension](int cell, std::vector<double>& values) {
    add_tensions(*tasks, cells, cell, tension, values);
  });
  if constexpr (in_space) {
    field("curvature", "1/m", 1,
          [&cells, spacing](int cell, std::vector<double>& values) { add_curvatures(cells, cell, spacing, values); });
    snapshot.triangles = [&cells](int cell) -> const Triangles& { return cells.type_of(cell).mesh.triangles(); };
  }
  return snapshot;
}

#define ROULEAU_INSTANTIATE(T, Set) \
  template MembraneSnapshot observe_membranes(core::Solver<T, Set>&, const units::LatticeUnits&);
ROULEAU_INSTANTIATE(float, core::D2Q9)
ROULEAU_INSTANTIATE(double, core::D2Q9)
ROULEAU_INSTANTIATE(float, core::D3Q19)
ROULEAU_INSTANTIATE(double, core::D3Q19)
#undef ROULEAU_INSTANTIATE

}  // namespace rouleau::observe
