#include "particle_stress.hpp"

#include <cmath>

#include "cell_sums.hpp"
#include "core/membrane/geometry.hpp"

namespace rouleau::observe {

double particle_stress(const core::Membranes& m, const scene::Scene& scene, double viscosity,
                       const core::Ranks<2>& ranks) {
  const double all = sum_over(m, ranks, [&](int number) {
    double stress = 0;
    const core::CellRange& cell = m.cells[number];
    const Eigen::Vector2d c = core::centroid(m, cell);
    const double ratio = scene.cell_types[cell.type].interior_viscosity / scene.fluid.viscosity;
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto k = static_cast<std::size_t>(i), n = static_cast<std::size_t>(cell.next(i));
      stress -= m.force_x[k] * (m.y[k] - c.y());
      // Outward normal times length of segment i, nodes counter-clockwise.
      const double nx = m.y[n] - m.y[k], ny = m.x[k] - m.x[n];
      const double ux = (m.velocity_x[k] + m.velocity_x[n]) / 2, uy = (m.velocity_y[k] + m.velocity_y[n]) / 2;
      stress += viscosity * (ratio - 1) * (ux * ny + uy * nx);
    }
    return stress;
  });
  return all / (static_cast<double>(scene.domain.nodes[0]) * scene.domain.nodes[1]);
}

double particle_stress(const core::Surfaces& s, const scene::Scene& scene, double viscosity,
                       const core::Ranks<3>& ranks) {
  const double all = sum_over(s, ranks, [&](int c) {
    double stress = 0;
    const core::CellRange& cell = s.cells[c];
    const core::Mesh& mesh = s.type_of(c).mesh;
    const double middle = core::inertia_ellipsoid(mesh, s.nodes(c)).center.y();
    for (int i = cell.first; i < cell.end(); ++i) stress -= s.force_x[i] * (s.y[i] - middle);
    const double ratio = scene.cell_types[cell.type].interior_viscosity / scene.fluid.viscosity;
    if (ratio == 1) return stress;
    const std::vector<core::Vec<3>> twice_area = core::area_vectors(mesh, s.nodes(c));
    std::size_t t = 0;
    for (const auto& corners : mesh.triangles()) {
      double ux = 0, uy = 0;
      for (const int node : corners)
        ux += s.velocity_x[cell.first + node] / 3, uy += s.velocity_y[cell.first + node] / 3;
      stress += viscosity * (ratio - 1) * (ux * twice_area[t].y() + uy * twice_area[t].x()) / 2;
      ++t;
    }
    return stress;
  });
  if (!scene.domain.tube_radius) return all / scene.domain.node_count();
  return all / (scene.domain.content() / std::pow(scene.domain.size.x() / scene.domain.nodes[0], 3));
}

}  // namespace rouleau::observe
