// What drives a flow between walls and changes in time, by a sine or a ramp; the velocity to which the sine settles.
#pragma once

#include "walls.hpp"

namespace rouleau::core {

/// What is added to the walls' speeds and to the body force: amplitudes times sin(2 pi frequency t), or times what
/// rises from -1 to 1 in `ramp` steps; t in time steps since the fluid was started. Lattice units.
struct Oscillation {
  WallVelocity walls = {};
  double body_force_x = 0;
  double frequency = 0;  ///< periods in a time step; 0: nothing oscillates
  double ramp = 0;       ///< time steps; 0: there is none

  [[nodiscard]] bool any() const { return frequency != 0 || ramp != 0; }
  /// What the amplitudes are multiplied with.
  [[nodiscard]] double at(double t) const;
};

/// Velocity along x and its slope; lattice units.
struct ProfilePoint {
  double velocity, slope;
};

/// The part of a fluid's velocity that oscillates, at t = 0, long after the oscillation has begun: the solution of
/// du/dt = nu d2u/dy2 + F between walls `height` apart (Stokes layers, Womersley flow). `y`: from the middle.
ProfilePoint oscillating_profile(const Oscillation& oscillation, double viscosity, double height, double y);

}  // namespace rouleau::core
