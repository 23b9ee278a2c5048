#include "solver_setup.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "constants.hpp"
#include "core/geometry/border_of_region.hpp"
#include "core/geometry/parts.hpp"
#include "shape/walls.hpp"

namespace rouleau::plan {

namespace {

/// The true area of the section at the first nodes along x, over that of its fluid nodes.
template <int D>
double inlet_share(const scene::Scene& scene, const LatticeWalls<D>& walls) {
  const core::Domain<D> domain = scene::lattice_domain<D>(scene);
  core::Domain<D> column = domain;
  column.block.end[0] = 1;
  double nodes = 0, area = 0;
  for (int i = 0; i < row_count(column.block); ++i) {
    std::array<int, D> node{};
    const auto row = row_of(column.block, i);
    std::copy(row.begin(), row.end(), node.begin() + 1);
    nodes += walls.solid->at(node) ? 0 : 1;
  }
  if (scene.domain.tube_radius) {
    area = std::numbers::pi * std::pow(*scene.domain.tube_radius / scene::lattice_spacing(scene), 2);
  } else {
    constexpr double half_of_slice = 1e-3;
    core::Vec<D> middle = core::Vec<D>::Zero(), half = core::Vec<D>::Constant(half_of_slice);
    for (int k = 1; k < D; ++k) half[k] = 0.5 * domain.size[k], middle[k] = half[k] - 0.5;
    area = core::content_of<D>(*walls.region, middle, half, shape::content_halvings) / (2 * half_of_slice);
  }
  if (nodes == 0)
    throw Error(Cause::bad_input, scene.place(scene.domain.openings->front().pointer),
                "the inlet leads into a wall: none of the lattice's nodes there is fluid",
                {"let the walls leave it open, or take more nodes"});
  return area / nodes;
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

  core::BasicSolverSetup<D> setup{
      .domain = scene::lattice_domain<D>(scene),
      .openings = stage.openings,
      .region = walls.region,
      .solid = walls.solid,
      .wall_area = walls.area,
      .tau = stage.tau,
      .layers = scene::lattice_layers(scene),
      .inertia = scene.fluid.inertia,
      .follow_cells = plan.facts.stages[index].follows_cells,
      .walls = stage.walls,
      .body_force_x = stage.openings ? 0 : stage.body_force.x(),
      .body_force_y = stage.body_force.y(),
      .body_force_z = stage.body_force.z(),
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
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    if (!plan.interactions[i].active()) continue;
    const scene::Interaction& interaction = scene.interactions[i];
    const core::Potential& potential = made.interactions[i];
    if (interaction.with_wall()) {
      setup.wall_interactions.push_back({.type = interaction.between[0], .potential = potential});
    } else if (interaction.with_self()) {
      setup.self_interactions.push_back({.type = interaction.between[0], .potential = potential});
    } else {
      setup.interactions.push_back({.between = interaction.between, .potential = potential});
    }
  }
  return setup;
}

template core::BasicSolverSetup<2> make_solver_setup(const Plan&, int, const LatticeWalls<2>&);
template core::BasicSolverSetup<3> make_solver_setup(const Plan&, int, const LatticeWalls<3>&);

}  // namespace rouleau::plan
