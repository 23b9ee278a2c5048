#include "solver_setup.hpp"

#include "kernel_facts.hpp"
#include "plugin/handles.hpp"

namespace rouleau::plan {

core::Domain<2> lattice_domain(const scene::Scene& scene) {
  return {{scene.domain.nodes[0], scene.domain.nodes[1]}, {true, scene.domain.periodic_y}};
}

core::SolverSetup make_solver_setup(const Plan& plan, int index) {
  const scene::Scene& scene = *plan.scene;
  const StageSetting& stage = plan.stages[index];
  const plugin::ModelSetting setting = stage.model_setting(scene.fluid.inertia);
  const auto values = [](const PlannedModel& model) -> const std::vector<double>& { return model.parameters.values; };

  core::SolverSetup setup{
      .domain = lattice_domain(scene),
      .tau = stage.tau,
      .inertia = scene.fluid.inertia,
      .walls = {-stage.wall_speed, stage.wall_speed},
      .body_force_x = stage.body_force_x,
      .body_force_y = stage.body_force_y,
      .developed = stage.stage->start == scene::WallStart::developed,
      .collision = plugin::make_collision_operator(*plan.collision.manifest, values(plan.collision), setting),
      .kernel = kernel_named(scene.numerics.kernel).kind,
      .semi_implicit = plan.semi_implicit,
      .slip_correction = scene.numerics.slip_correction,
      .area_correction = scene.numerics.area_correction,
      .time_step = stage.stage->density_factor,  // proportional to it
      .tension_unit = stage.units.unit(units::dimension::tension)};
  if (!plan.has_cells) return setup;
  for (std::size_t t = 0; t < scene.cell_types.size(); ++t) {
    core::CellType& type = setup.cell_types.emplace_back();
    type.viscosity_ratio = scene.cell_types[t].interior_viscosity / scene.fluid.viscosity;
    for (const PlannedModel& law : plan.membranes[t]) {
      if (law.active()) type.laws.push_back(plugin::make_membrane_law(*law.manifest, values(law), setting));
    }
  }
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    const PlannedModel& potential = plan.interactions[i];
    if (!potential.active()) continue;
    setup.interactions.push_back(
        {.between = scene.interactions[i].between,
         .potential = plugin::make_potential(*potential.manifest, values(potential), setting)});
  }
  return setup;
}

}  // namespace rouleau::plan
