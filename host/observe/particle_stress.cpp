#include "particle_stress.hpp"

#include "core/membrane/geometry.hpp"

namespace rouleau::observe {

double particle_stress(const core::Membranes& m, const scene::Scene& scene, double viscosity) {
  double stress = 0;
  for (const core::CellRange& cell : m.cells) {
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
  }
  return stress / (static_cast<double>(scene.domain.nodes[0]) * scene.domain.nodes[1]);
}

}  // namespace rouleau::observe
