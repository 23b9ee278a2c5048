#include "particle_stress.hpp"

#include <cmath>

#include "cell_sums.hpp"
#include "core/membrane/geometry.hpp"

namespace rouleau::observe {

namespace {

/// -F_x y of a cell's nodes, from the middle of the box, and of what acts on them through images of other cells.
double stress_of_forces(const core::CellNodes& nodes, int cell, const scene::Scene& scene,
                        const ForceAcrossImages& across_images) {
  const double height = scene.domain.nodes[1], middle = (height - 1) / 2;
  double stress = across_images ? height * across_images(cell) : 0;
  const core::CellRange& range = nodes.cells[cell];
  for (int i = range.first; i < range.end(); ++i) stress -= nodes.force[0][i] * (nodes.position[1][i] - middle);
  return stress;
}

/// Of the fluid, in volumes or areas of a node.
double fluid_content(const scene::Domain& domain) {
  if (!domain.tube_radius && !domain.has_shapes()) return domain.node_count();
  return domain.content() / std::pow(domain.size.x() / domain.nodes[0], domain.dimension());
}

}  // namespace

double particle_stress(const core::Membranes& m, const scene::Scene& scene, double viscosity,
                       const core::Ranks<2>& ranks, const ForceAcrossImages& across_images) {
  const double all = sum_over(m, ranks, [&](int number) {
    double stress = stress_of_forces(m, number, scene, across_images);
    const core::CellRange& cell = m.cells[number];
    const double ratio = scene.cell_types[cell.type].interior_viscosity / scene.fluid.viscosity;
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto k = static_cast<std::size_t>(i), n = static_cast<std::size_t>(cell.next(i));
      // Outward normal times length of segment i, nodes counter-clockwise.
      const double nx = m.position[1][n] - m.position[1][k], ny = m.position[0][k] - m.position[0][n];
      const double ux = (m.velocity[0][k] + m.velocity[0][n]) / 2, uy = (m.velocity[1][k] + m.velocity[1][n]) / 2;
      stress += viscosity * (ratio - 1) * (ux * ny + uy * nx);
    }
    return stress;
  });
  return all / fluid_content(scene.domain);
}

double particle_stress(const core::Surfaces& s, const scene::Scene& scene, double viscosity,
                       const core::Ranks<3>& ranks, const ForceAcrossImages& across_images) {
  const double all = sum_over(s, ranks, [&](int c) {
    double stress = stress_of_forces(s, c, scene, across_images);
    const core::CellRange& cell = s.cells[c];
    const core::Mesh& mesh = s.type_of(c).mesh;
    const double ratio = scene.cell_types[cell.type].interior_viscosity / scene.fluid.viscosity;
    if (ratio == 1) return stress;
    const std::vector<core::Vec<3>> twice_area = core::area_vectors(mesh, s.nodes(c));
    std::size_t t = 0;
    for (const auto& corners : mesh.triangles()) {
      double ux = 0, uy = 0;
      for (const int node : corners)
        ux += s.velocity[0][cell.first + node] / 3, uy += s.velocity[1][cell.first + node] / 3;
      stress += viscosity * (ratio - 1) * (ux * twice_area[t].y() + uy * twice_area[t].x()) / 2;
      ++t;
    }
    return stress;
  });
  return all / fluid_content(scene.domain);
}

}  // namespace rouleau::observe
