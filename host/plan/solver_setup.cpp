#include "solver_setup.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "constants.hpp"
#include "core/fluid/openings/section.hpp"
#include "core/geometry/border.hpp"
#include "core/geometry/parts.hpp"
#include "placed_cells.hpp"
#include "scene/driving_flow.hpp"
#include "shape/extent.hpp"
#include "shape/surface.hpp"
#include "shape/walls.hpp"

namespace rouleau::plan {

namespace {

/// The true area of the section at the first nodes along the open axis, over that of its fluid nodes.
template <int D>
double inlet_share(const scene::Scene& scene, const LatticeWalls<D>& walls) {
  const core::Domain<D> domain = scene::lattice_domain<D>(scene);
  const core::SectionNodes<D> section(domain);
  double nodes = 0, area = 0;
  for (int i = 0; i < section.count(); ++i) nodes += walls.solid->at(section.node(i, 0)) ? 0 : 1;
  if (scene.domain.tube_radius) {
    area = std::numbers::pi * std::pow(*scene.domain.tube_radius / scene::lattice_spacing(scene), 2);
  } else {
    constexpr double half_of_slice = 1e-3;
    core::Vec<D> middle = core::Vec<D>::Zero(), half = core::Vec<D>::Constant(half_of_slice);
    for (int k = 0; k < D; ++k)
      if (k != section.axis()) half[k] = 0.5 * domain.size[k], middle[k] = half[k] - 0.5;
    area = core::content_of<D>(*walls.region, middle, half, shape::content_halvings) / (2 * half_of_slice);
  }
  if (nodes == 0)
    throw Error(Cause::bad_input, scene.place(scene.domain.openings->front().pointer),
                "the inlet leads into a wall: none of the lattice's nodes there is fluid",
                {"let the walls leave it open, or take more nodes"});
  return area / nodes;
}

/// What lies furthest toward a direction, until it has the share of the membrane; of nodes that lie equally far all,
/// and of the last of these so much of each as is wanted.
core::ForcePatch make_patch(const std::vector<double>& along, const std::vector<double>& measure, double share) {
  std::vector<int> order(along.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return along[a] > along[b]; });
  const double equal = 1e-9 * (along[order.front()] - along[order.back()]);
  const double wanted = share * std::accumulate(measure.begin(), measure.end(), 0.0);
  core::ForcePatch patch;
  double left = wanted;
  for (std::size_t first = 0, end = 0; first < order.size() && left > 1e-12 * wanted;) {
    double group = 0;
    while (end < order.size() && along[order[end]] >= along[order[first]] - equal) group += measure[order[end++]];
    for (; first < end; ++first) {
      patch.node.push_back(order[first]);
      patch.share.push_back(std::min(1.0, left / group) * measure[order[first]] / wanted);
    }
    left -= group;
  }
  return patch;
}

/// Of each cell, where a force acts on it; cells that are placed alike share it.
template <int D>
std::vector<std::shared_ptr<const core::ForcePatch>> patches(const scene::Scene& scene, const scene::CellForce& force,
                                                             const core::Cells<D>& types) {
  std::vector<std::shared_ptr<const core::ForcePatch>> of_cell(scene.cells.size());
  std::map<std::array<double, 4>, std::shared_ptr<const core::ForcePatch>> alike;
  for (std::size_t c = 0; c < of_cell.size(); ++c) {
    if (!force.pulls_at(static_cast<int>(c))) continue;
    const scene::CellPlacement& cell = scene.cells[c];
    const auto& rest = *types.types[cell.type];
    const Eigen::Vector3d to = shape::rotation_of(cell).transpose() * force.toward.in<3>();  // as the shape is given
    auto& patch = alike[{static_cast<double>(cell.type), to.x(), to.y(), to.z()}];
    if (!patch) {
      std::vector<double> along;
      for (std::size_t i = 0; i < rest.x.size(); ++i) {
        along.push_back(to.x() * rest.x[i] + to.y() * rest.y[i]);
        if constexpr (requires { rest.z; }) along.back() += to.z() * rest.z[i];
      }
      patch = std::make_shared<const core::ForcePatch>(make_patch(along, rest.node_measure(), force.share));
    }
    of_cell[c] = patch;
  }
  return of_cell;
}

/// What acts on cells from outside. Where nothing holds the fluid it is held against their weight, on average.
template <int D>
void add_external_forces(const scene::Scene& scene, const scene::StageSetting& stage,
                         core::BasicSolverSetup<D>& setup) {
  const double force = stage.units.unit(units::dimension::force(D));
  if (!stage.stage->forces.empty()) {
    const core::Cells<D> types = without_cells<D>(scene, stage.units.length);
    for (const scene::CellForce& pull : stage.stage->forces)
      setup.external.pulls.push_back({.before = pull.before.template in<D>() / force,
                                      .after = pull.force.template in<D>() / force,
                                      .ramp_steps = pull.ramp / stage.units.time,
                                      .patch = patches<D>(scene, pull, types)});
  }
  const core::Vec<D> gravity = scene.fluid.gravity.template in<D>() / stage.units.unit(units::dimension::force_density);
  if (gravity.isZero(0)) return;
  double excess = 0;  // mass, kg, in two dimensions per depth
  for (const scene::CellType& type : scene.cell_types) {
    const double denser = type.interior_density - scene.fluid.density;
    const auto t = static_cast<int>(setup.external.weight.size());
    setup.external.weight.emplace_back(denser * gravity);
    excess += denser * shape::enclosed_by(type) *
              static_cast<double>(std::count_if(scene.cells.begin(), scene.cells.end(),
                                                [t](const scene::CellPlacement& cell) { return cell.type == t; }));
  }
  if (scene::has_walls(scene.domain) || scene.domain.is_open()) return;
  double* const body_force[] = {&setup.body_force_x, &setup.body_force_y, &setup.body_force_z};
  for (int k = 0; k < D; ++k) *body_force[k] -= excess / scene.domain.size.product() * gravity[k];
}

}  // namespace

template <int D>
LatticeWalls<D> lattice_walls(const scene::Scene& scene) {
  LatticeWalls<D> walls{.region = scene::fluid_region<D>(scene)};
  if (!walls.region) return walls;
  const core::Domain<D> domain = scene::lattice_domain<D>(scene);
  walls.solid = std::make_shared<const core::SolidNodes<D>>(domain.size, walls.region);
  if (scene.domain.tube_radius) {
    walls.area = 2 * std::numbers::pi * (*scene.domain.tube_radius / scene::lattice_spacing(scene)) * domain.size[0];
  } else {
    const auto open = core::intersection<D>({walls.region, core::between_walls<D>(domain)});
    walls.area = core::size_of<D>(core::border_of_region(*open, domain));
  }
  if (scene.domain.openings) walls.inlet_share = inlet_share(scene, walls);
  return walls;
}
template LatticeWalls<2> lattice_walls(const scene::Scene&);
template LatticeWalls<3> lattice_walls(const scene::Scene&);

template <int D>
core::BasicSolverSetup<D> make_solver_setup(const Plan& plan, int index, const LatticeWalls<D>& walls) {
  const scene::Scene& scene = *plan.scene;
  const scene::StageSetting& stage = plan.stages[index];
  const StageModels& made = *plan.made[index];

  scene::Vector body_force = stage.body_force;
  if (stage.openings) body_force[scene.domain.open_axis] = 0;
  core::BasicSolverSetup<D> setup{
      .domain = scene::lattice_domain<D>(scene),
      .openings = stage.openings,
      .region = walls.region,
      .solid = walls.solid,
      .wall_time = scene.domain.shape_speed > 0 ? stage.units.time : 0,
      .wall_area = walls.area,
      .tau = stage.tau,
      .layers = scene::lattice_layers(scene),
      .inertia = scene.fluid.inertia,
      .follow_cells = plan.facts.stages[index].follows_cells,
      .walls = stage.walls,
      .body_force_x = body_force.x(),
      .body_force_y = body_force.y(),
      .body_force_z = body_force.z(),
      .oscillation = stage.oscillation,
      // Without cells the gradient that this flow takes is known.
      .mean_velocity = (plan.has_cells || scene.domain.has_shapes()) && stage.stage->mean_velocity
                           ? stage.units.to_lattice(*stage.stage->mean_velocity, units::dimension::velocity)
                           : 0,
      .developed = stage.stage->start == scene::WallStart::developed,
      .collision = made.collision,
      .kernel = kernel_named(scene.numerics.kernel).kind,
      .semi_implicit = plan.semi_implicit,
      .slip_correction = scene.numerics.slip_correction,
      .area_correction = scene.numerics.area_correction,
      .strain_per_step = plan.facts.stages[index].shear_rate * stage.units.time,
      .time_step = stage.stage->density_factor,  // proportional to it
      .tension_unit = stage.units.unit(units::dimension::tension)};
  if (setup.openings && setup.openings->front().kind == core::Opening::Kind::velocity)
    setup.openings->front().value *= walls.inlet_share;
  if (walls.region) {
    const double spacing = scene::lattice_spacing(scene);
    // The mean over the true section, when the solver goes by that over its nodes.
    setup.mean_velocity *=
        scene.domain.content() / std::pow(spacing, D) / static_cast<double>(walls.solid->fluid_count());
    setup.width = scene.domain.region_width / spacing;
    if (scene.domain.tube_radius) {
      const double radius = *scene.domain.tube_radius / spacing;
      setup.section_flow = [radius](double y, double z, double force) { return core::tube_flow(radius, force, y, z); };
    }
  }
  if (!plan.has_cells) return setup;
  for (std::size_t t = 0; t < scene.cell_types.size(); ++t) {
    core::CellType& type = setup.cell_types.emplace_back();
    type.viscosity_ratio = scene.cell_types[t].interior_viscosity / scene.fluid.viscosity;
    type.laws = made.membranes[t];
  }
  add_external_forces(scene, stage, setup);
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    if (!plan.interactions[i].active()) continue;
    const scene::Interaction& interaction = scene.interactions[i];
    const core::Potential& potential = made.interactions[i];
    core::Course strength;
    if (!stage.stage->strengths.empty()) {
      const auto& [values, steps] = stage.stage->strengths[i];
      strength = {values, steps, values.size() > 1 ? *stage.stage->duration / stage.units.time : 0};
    }
    if (interaction.with_wall())
      setup.wall_interactions.push_back({interaction.between[0], potential, strength});
    else if (interaction.with_self())
      setup.self_interactions.push_back({interaction.between[0], potential, strength});
    else
      setup.interactions.push_back({interaction.between, potential, strength});
  }
  return setup;
}

template core::BasicSolverSetup<2> make_solver_setup(const Plan&, int, const LatticeWalls<2>&);
template core::BasicSolverSetup<3> make_solver_setup(const Plan&, int, const LatticeWalls<3>&);

}  // namespace rouleau::plan
