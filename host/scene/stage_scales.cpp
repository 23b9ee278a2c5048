#include "stage_scales.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.hpp"
#include "base/text.hpp"
#include "core/fluid/relaxation.hpp"

namespace rouleau::scene {

namespace {

/// Integral of |base + amplitude sin(phase)| from 0 to `phase`.
double integral_of_magnitude(double base, double amplitude, double phase) {
  constexpr double turn = 2 * std::numbers::pi;
  const auto integral = [&](double p) { return base * p + amplitude * (1 - std::cos(p)); };
  // Where the sign changes, within a turn.
  std::array<double, 2> zeros{turn, turn};
  if (std::abs(amplitude) > std::abs(base)) {
    const double zero = std::asin(-base / amplitude);
    zeros = {zero < 0 ? zero + turn : zero, std::numbers::pi - zero};
    std::sort(zeros.begin(), zeros.end());
  }
  const auto up_to = [&](double end) {
    double sum = 0, from = 0;
    for (const double zero : {zeros[0], zeros[1], end}) {
      const double to = std::min(zero, end);
      sum += std::abs(integral(to) - integral(from));
      from = to;
    }
    return sum;
  };
  const double turns = std::floor(phase / turn);
  return turns * up_to(turn) + up_to(phase - turns * turn);
}

}  // namespace

double StageSetting::strain_after(long steps) const {
  const auto time = static_cast<double>(steps);
  if (!oscillation.any()) return std::abs(shear_rate) * time;
  if (oscillation.ramp != 0) {
    // Twice the integral of |rate|, of a rate that changes evenly: rate |rate| over its change in a step.
    const auto twice = [](double rate) { return rate * std::abs(rate); };
    const double first = shear_rate - oscillating_rate, change = 2 * oscillating_rate / oscillation.ramp;
    return change == 0 ? std::abs(shear_rate) * time : (twice(first + change * time) - twice(first)) / (2 * change);
  }
  const double omega = 2 * std::numbers::pi * oscillation.frequency;
  return integral_of_magnitude(shear_rate, oscillating_rate, omega * time) / omega;
}

StageSetting make_stage_setting(const Scene& scene, int index) {
  const Stage& stage = scene.stages[index];
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
  setting.walls = {-(apart - mean), apart + mean};
  setting.shape_speed = setting.units.to_lattice(scene.domain.shape_speed, units::dimension::velocity);
  setting.body_force = driving_force(stage, scene);
  for (double& along : setting.body_force) along = setting.units.to_lattice(along, units::dimension::force_density);
  if (scene.domain.openings) {
    const auto& [inlet, outlet] = *scene.domain.openings;
    core::Opening& lower = setting.openings.emplace()[0];
    if (inlet.pressure) {
      lower.value = setting.units.to_lattice(*inlet.pressure - *outlet.pressure, units::dimension::pressure);
    } else {
      lower = {core::Opening::Kind::velocity,
               setting.units.to_lattice(*inlet.mean_velocity, units::dimension::velocity)};
    }
  }
  setting.dimension = scene.domain.dimension();

  if (stage.changes()) {
    const Oscillation& added = stage.oscillation;
    const double together = setting.units.to_lattice(added.mean_wall_speed, units::dimension::velocity);
    setting.oscillating_rate = setting.units.to_lattice(added.shear_rate, units::dimension::rate);
    const double against = setting.oscillating_rate * scene.domain.nodes[1] / 2;
    setting.oscillation = {
        .walls = {together - against, together + against},
        .body_force_x = setting.units.to_lattice(added.pressure_gradient, units::dimension::force_density),
        .frequency = setting.units.to_lattice(added.frequency, units::dimension::rate),
        .ramp = added.ramp ? *stage.duration / setting.units.time : 0};
  }

  double steps = std::numeric_limits<double>::infinity();
  if (stage.duration) steps = std::min(steps, *stage.duration / setting.units.time);
  if (stage.strain) steps = std::min(steps, *stage.strain / std::abs(setting.shear_rate));
  constexpr double most = 1e15;
  if (!(steps <= most)) {
    throw Error(
        Cause::bad_input, scene.place(stage.pointer),
        "stage " + in_quotes(stage.name) + " would take " + number(steps, 3) + " steps, more than any run can (1e15)",
        {"shorten its duration or strain, or let the lattice take longer steps: a higher " + stage.density_factor_key +
         ", a coarser lattice"});
  }
  setting.max_steps = static_cast<long>(std::ceil(steps - 1e-6));
  return setting;
}

}  // namespace rouleau::scene
