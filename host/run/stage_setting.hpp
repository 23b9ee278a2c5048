// One stage in lattice units: the conversions that a stage's density factor decides.
#pragma once

#include "fluid/fluid.hpp"
#include "input/lattice_units.hpp"
#include "input/scene.hpp"
#include "plugin/model.hpp"

namespace rouleau::host {

struct StageSetting {
  const Stage* stage;
  int index;
  LatticeUnits units;
  double tau;
  double shear_rate;                  ///< lattice
  double wall_speed;                  ///< lattice, of the upper wall; the lower one moves the other way
  double body_force_x, body_force_y;  ///< lattice, body force and pressure gradient
  long max_steps;                     ///< of duration or strain, whichever is shorter

  [[nodiscard]] ModelSetting model_setting(bool inertia) const { return {units, 1 / tau, inertia}; }
  [[nodiscard]] FluidSetting fluid_setting(const Scene& scene, bool membranes, bool viscosity_contrast) const;
  /// Walls or a force put energy in.
  [[nodiscard]] bool is_driven() const { return shear_rate != 0 || body_force_x != 0 || body_force_y != 0; }
  /// Steps from one output to the next for a time interval in seconds (at least one).
  [[nodiscard]] double steps_of(double seconds) const { return seconds / units.time; }
};

/// Spacing of the lattice, m.
double lattice_spacing(const Scene& scene);

/// Conversions of stage `index`: with density rho f (f the density factor) as unit, dt = (tau - 1/2)/3 dx^2 rho f / mu.
StageSetting make_stage_setting(const Scene& scene, int index);

}  // namespace rouleau::host
