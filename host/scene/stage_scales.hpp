// One stage in lattice units: the conversions that a stage's density factor decides.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/fluid/developed_flow.hpp"
#include "core/fluid/openings/opening.hpp"
#include "driving_flow.hpp"
#include "lattice.hpp"
#include "scene.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::scene {

struct StageSetting {
  const Stage* stage;
  int index;
  units::LatticeUnits units;
  double tau;
  double shear_rate;              ///< lattice
  core::WallVelocity walls;       ///< lattice
  double shape_speed;             ///< lattice, the largest of walls that are no planes
  Vector body_force;              ///< lattice, body force and pressure gradient; of openings what they amount to
  core::Openings openings;        ///< lattice, mean velocity over the inlet's true area, pressures above the outlet's
  core::Oscillation oscillation;  ///< lattice, of walls and body force
  double oscillating_rate;        ///< lattice, amplitude of the shear rate
  long max_steps;                 ///< of duration or strain, whichever is shorter
  int dimension;

  /// Walls or a force put energy in.
  [[nodiscard]] bool is_driven() const { return openings || fastest_wall() != 0 || largest_body_force() != Vector(); }
  /// Largest speed of a wall and largest force that there may be, oscillation included; lattice.
  [[nodiscard]] double fastest_wall() const {
    return std::max({std::abs(walls.lower) + std::abs(oscillation.walls.lower),
                     std::abs(walls.upper) + std::abs(oscillation.walls.upper), shape_speed});
  }
  [[nodiscard]] Vector largest_body_force() const {
    Vector force = body_force;
    force.x() = std::abs(force.x()) + std::abs(oscillation.body_force_x);
    return force;
  }
  /// Largest force that drives a flow, along any axis: what no wall takes; lattice.
  [[nodiscard]] double largest_drive(const Domain& domain) const { return driving_part(largest_body_force(), domain); }
  /// Strain after so many steps of the stage: the shear rate's magnitude, over time.
  [[nodiscard]] double strain_after(long steps) const;
  /// Steps from one output to the next for a time interval in seconds (at least one).
  [[nodiscard]] double steps_of(double seconds) const { return seconds / units.time; }
};

/// Conversions of stage `index`: with density rho f (f the density factor) as unit, dt = (tau - 1/2)/3 dx^2 rho f / mu.
StageSetting make_stage_setting(const Scene& scene, int index);

}  // namespace rouleau::scene
