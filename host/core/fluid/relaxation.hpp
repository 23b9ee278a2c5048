// Relaxation time and viscosity of the lattice's fluid: the one place that knows how they go together.
#pragma once

namespace rouleau::core {

/// Kinematic viscosity, in spacings^2 per step, of a relaxation time in steps.
constexpr double viscosity_of(double relaxation_time) { return (relaxation_time - 0.5) / 3; }

/// Relaxation time, in steps, of a kinematic viscosity in spacings^2 per step.
constexpr double relaxation_time_of(double viscosity) { return 0.5 + 3 * viscosity; }

/// Seconds of one step in which the lattice's viscosity is the fluid's, m2/s, on a spacing in m.
constexpr double time_step(double relaxation_time, double spacing, double kinematic_viscosity) {
  return viscosity_of(relaxation_time) * spacing * spacing / kinematic_viscosity;
}

}  // namespace rouleau::core
