#include "stage_scales.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"
#include "core/fluid/relaxation.hpp"

namespace rouleau::plan {

double lattice_spacing(const scene::Scene& scene) { return scene.domain.size.x() / scene.domain.nodes[0]; }

StageSetting make_stage_setting(const scene::Scene& scene, int index) {
  const scene::Stage& stage = scene.stages[index];
  const double spacing = lattice_spacing(scene);
  const double density = scene.fluid.density * stage.density_factor;
  const double tau = scene.numerics.tau;

  StageSetting setting{};
  setting.stage = &stage;
  setting.index = index;
  setting.units.length = spacing;
  setting.units.time = core::time_step(tau, spacing, scene.fluid.viscosity / density);
  setting.units.mass = density * spacing * spacing * spacing;
  setting.tau = tau;
  setting.shear_rate = setting.units.to_lattice(stage.shear_rate, units::dimension::rate);
  const double mean = setting.units.to_lattice(stage.mean_wall_speed, units::dimension::velocity);
  const double apart = setting.shear_rate * scene.domain.nodes[1] / 2;
  setting.walls = {mean - apart, mean + apart};
  const Eigen::Vector2d force = scene.fluid.body_force + stage.pressure_gradient;
  setting.body_force_x = setting.units.to_lattice(force.x(), units::dimension::force_density);
  setting.body_force_y = setting.units.to_lattice(force.y(), units::dimension::force_density);

  double steps = std::numeric_limits<double>::infinity();
  if (stage.duration) steps = std::min(steps, *stage.duration / setting.units.time);
  if (stage.strain) steps = std::min(steps, *stage.strain / std::abs(setting.shear_rate));
  constexpr double most = 1e15;
  if (!(steps <= most)) {
    throw Error(
        Cause::bad_input, scene.place(stage.pointer),
        "stage " + in_quotes(stage.name) + " would take " + number(steps, 3) + " steps, more than any run can (1e15)",
        {"shorten its duration or strain, or let the lattice take longer steps: a higher density_factor, a coarser "
         "lattice"});
  }
  setting.max_steps = static_cast<long>(std::ceil(steps - 1e-6));
  return setting;
}

}  // namespace rouleau::plan
