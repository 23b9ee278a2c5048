#include "rheology.hpp"

#include <cmath>
#include <limits>

#include "cell_measures.hpp"
#include "cell_sums.hpp"
#include "core/fluid/developed_flow.hpp"
#include "core/fluid/relaxation.hpp"
#include "core/membrane/geometry.hpp"

namespace rouleau::observe {

namespace {

using Stress = std::array<double, 4>;  // xy, xx, yy, zz

/// -F_x y, -F_x x, -F_y y and -F_z z of a cell's nodes, from the middle of the box, and of what acts on them through
/// images of other cells.
Stress stress_of_forces(const core::CellNodes& nodes, int cell, const scene::Scene& scene,
                        const ForceAcrossImages& across_images) {
  Stress stress{};
  if (across_images) stress = across_images(cell);
  const auto& box = scene.domain.nodes;
  const std::size_t axes = box.size();
  stress[0] *= box[1];
  for (std::size_t k = 0; k < axes; ++k) stress[k + 1] *= box[k];
  const core::CellRange& range = nodes.cells[cell];
  for (int i = range.first; i < range.end(); ++i) {
    stress[0] -= nodes.force[0][i] * (nodes.position[1][i] - (box[1] - 1) / 2.0);
    for (std::size_t k = 0; k < axes; ++k)
      stress[k + 1] -= nodes.force[k][i] * (nodes.position[k][i] - (box[k] - 1) / 2.0);
  }
  return stress;
}

/// Of a piece of membrane between two viscosities that differ by `excess`: area times outward normal, and velocity.
void add_contrast(Stress& stress, double excess, const std::array<double, 3>& normal,
                  const std::array<double, 3>& velocity) {
  stress[0] += excess * (velocity[0] * normal[1] + velocity[1] * normal[0]);
  for (std::size_t k = 0; k < 3; ++k) stress[k + 1] += 2 * excess * velocity[k] * normal[k];
}

ParticleStress per_content(const Stress& all, double content) {
  return {all[0] / content, (all[1] - all[2]) / content, (all[2] - all[3]) / content};
}

/// Of the fluid, in volumes or areas of a node.
double fluid_content(const scene::Domain& domain) {
  if (!domain.tube_radius && !domain.has_shapes()) return domain.node_count();
  return domain.content() / std::pow(domain.size.x() / domain.nodes[0], domain.dimension());
}

}  // namespace

bool is_driven_channel(const scene::StageSetting& setting, const scene::Scene& scene) {
  return setting.largest_body_force()[scene.domain.flow_axis()] != 0 && setting.fastest_wall() == 0 &&
         (scene.domain.walled(1) || scene.domain.has_shapes());
}

template <int D>
double flow_rate(const core::AnyFluid<D>& fluid, const std::vector<double>& row_velocities) {
  const core::Domain<D>& domain = fluid.setting().domain;
  double rate = core::flow_rate(row_velocities, fluid.walls_now(), domain, fluid.setting().solid != nullptr);
  for (int axis = 2; axis < D; ++axis) rate /= domain.size[axis == domain.flow_axis() ? 0 : axis];
  return rate;
}

template double flow_rate(const core::AnyFluid<2>&, const std::vector<double>&);
template double flow_rate(const core::AnyFluid<3>&, const std::vector<double>&);

template <int D>
double observe_openings(const core::AnyFluid<D>& fluid, const scene::Scene& scene, const units::LatticeUnits& units,
                        Snapshot& snapshot) {
  const auto [lower, upper] = fluid.end_flows();
  const double area = std::pow(units.length, D - 1), outside = *scene.domain.openings->back().pressure;
  snapshot.inlet_flow = units.to_si(lower.flow, units::dimension::velocity) * area;
  snapshot.outlet_flow = units.to_si(upper.flow, units::dimension::velocity) * area;
  for (const double flow : lower.of_parts)
    snapshot.opening_flow[0].push_back(units.to_si(flow, units::dimension::velocity) * area);
  for (const double flow : upper.of_parts)
    snapshot.opening_flow[1].push_back(units.to_si(flow, units::dimension::velocity) * area);
  snapshot.inlet_pressure = outside + units.to_si(lower.pressure, units::dimension::pressure);
  snapshot.outlet_pressure = outside + units.to_si(upper.pressure, units::dimension::pressure);
  return (lower.pressure - upper.pressure) / (scene.domain.nodes[scene.domain.open_axis] - 1);
}

template double observe_openings(const core::AnyFluid<2>&, const scene::Scene&, const units::LatticeUnits&, Snapshot&);
template double observe_openings(const core::AnyFluid<3>&, const scene::Scene&, const units::LatticeUnits&, Snapshot&);

double cell_flux(const core::Membranes& m, const core::Ranks<2>& ranks, int axis) {
  return sum_over(m, ranks, [&](int c) { return carried(m, c, axis); });
}
double cell_flux(const core::Surfaces& s, const core::Ranks<3>& ranks, int axis) {
  return sum_over(s, ranks, [&](int c) { return carried(s, c, axis); });
}

double apparent_viscosity(double flow_rate, double body_force, const scene::StageSetting& setting, int height) {
  const double viscosity = core::viscosity_of(setting.tau);
  const double alone = body_force * std::pow(height, 3) / (12 * viscosity);
  // In its first step a fluid at rest comes to flow at the force times the height.
  const bool flows = std::abs(flow_rate) > 1e-3 * std::abs(body_force) * height;
  return flows ? alone / flow_rate : std::nan("");
}

std::map<int, int> aggregate_sizes(const std::vector<int>& label) {
  std::map<int, int> members, sizes;
  for (const int l : label) ++members[l];
  for (const auto& [l, size] : members) ++sizes[size];
  return sizes;
}

double number_mean(const std::map<int, int>& sizes) {
  double cells = 0, aggregates = 0;
  for (const auto& [size, count] : sizes) {
    cells += static_cast<double>(size) * count;
    aggregates += count;
  }
  return cells / aggregates;
}

double weight_mean(const std::map<int, int>& sizes) {
  double cells = 0, squares = 0;
  for (const auto& [size, count] : sizes) {
    cells += static_cast<double>(size) * count;
    squares += static_cast<double>(size) * size * count;
  }
  return squares / cells;
}

ParticleStress particle_stress(const core::Membranes& m, const scene::Scene& scene, double viscosity,
                               const core::Ranks<2>& ranks, const ForceAcrossImages& across_images) {
  const Stress all = sums_over<4>(m, ranks, [&](int number) {
    Stress stress = stress_of_forces(m, number, scene, across_images);
    const core::CellRange& cell = m.cells[number];
    const double ratio = scene.cell_types[cell.type].interior_viscosity / scene.fluid.viscosity;
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto k = static_cast<std::size_t>(i), n = static_cast<std::size_t>(cell.next(i));
      // Outward normal times length of segment i, nodes counter-clockwise.
      add_contrast(stress, viscosity * (ratio - 1),
                   {m.position[1][n] - m.position[1][k], m.position[0][k] - m.position[0][n], 0},
                   {(m.velocity[0][k] + m.velocity[0][n]) / 2, (m.velocity[1][k] + m.velocity[1][n]) / 2, 0});
    }
    return stress;
  });
  ParticleStress stress = per_content(all, fluid_content(scene.domain));
  stress.second = std::numeric_limits<double>::quiet_NaN();
  return stress;
}

ParticleStress particle_stress(const core::Surfaces& s, const scene::Scene& scene, double viscosity,
                               const core::Ranks<3>& ranks, const ForceAcrossImages& across_images) {
  const Stress all = sums_over<4>(s, ranks, [&](int c) {
    Stress stress = stress_of_forces(s, c, scene, across_images);
    const core::CellRange& cell = s.cells[c];
    const core::Mesh& mesh = s.type_of(c).mesh;
    const double ratio = scene.cell_types[cell.type].interior_viscosity / scene.fluid.viscosity;
    if (ratio == 1) return stress;
    const std::vector<core::Vec<3>> twice_area = core::area_vectors(mesh, s.nodes(c));
    std::size_t t = 0;
    for (const auto& corners : mesh.triangles()) {
      std::array<double, 3> velocity{};
      for (const int node : corners)
        for (std::size_t k = 0; k < 3; ++k) velocity[k] += s.velocity[k][cell.first + node] / 3;
      const core::Vec<3>& normal = twice_area[t++];
      add_contrast(stress, viscosity * (ratio - 1) / 2, {normal.x(), normal.y(), normal.z()}, velocity);
    }
    return stress;
  });
  return per_content(all, fluid_content(scene.domain));
}

}  // namespace rouleau::observe
