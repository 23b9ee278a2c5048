// Flow along x without cells: what drives it steadily or in time, layers, profiles when developed, and flow rates.
#pragma once

#include <functional>
#include <vector>

#include "core/domain/domain.hpp"
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

/// Couette and Poiseuille flow along x between walls across y. Lattice units; y counts from the first row, half a
/// spacing from the lower wall.
struct ChannelFlow {
  double half_height = 0;  ///< between the walls
  double mean = 0;         ///< of the walls' velocities
  double rate = 0;         ///< du/dy in the middle
  double curvature = 0;    ///< -d2u/dy2

  [[nodiscard]] double from_middle(double y) const { return y - (half_height - 0.5); }
  [[nodiscard]] double velocity(double y) const {
    const double s = from_middle(y);
    return mean + rate * s + curvature * (half_height * half_height - s * s) / 2;
  }
  [[nodiscard]] double slope(double y) const { return rate - curvature * from_middle(y); }
};

/// What the walls and the body force of a setup without layers drive without cells; what oscillates is left out.
template <class Setup>
ChannelFlow channel_flow(const Setup& setup) {
  const int height = setup.domain.size[1];
  return {.half_height = height / 2.0,
          .mean = (setup.walls.upper + setup.walls.lower) / 2,
          .rate = (setup.walls.upper - setup.walls.lower) / height,
          .curvature = setup.body_force_x / setup.viscosity()};
}

/// Velocity along x and its derivatives; lattice units.
struct SectionPoint {
  double velocity = 0, slope_y = 0, slope_z = 0;
};
/// By y and z from the middle of the section, for a force per volume over the viscosity.
using SectionFlow = std::function<SectionPoint(double y, double z, double force)>;

/// Of a rectangular duct, between walls across y that may move along x, and walls across z at rest. Lattice units; y
/// and z count from the middle. White, Viscous Fluid Flow (2006), section 3-3; the walls' part is Laplace's equation in
/// a rectangle.
struct DuctFlow {
  double height = 0, width = 0;  ///< along y and z, from wall to wall
  WallVelocity walls = {};
  double force = 0;  ///< per volume, over the viscosity

  /// Inside, to rounding; near a corner of a wall that moves the series is longest.
  [[nodiscard]] SectionPoint at(double y, double z) const;
};

/// Of a tube at rest (Hagen and Poiseuille); at rest beyond its wall. `force`: per volume, over the viscosity.
SectionPoint tube_flow(double radius, double force, double y, double z);

/// The fluid between two heights. Lattice units; `from` and `to` from the lower edge of the lattice, half a spacing
/// below the first row of nodes.
struct Layer {
  double from, to;
  double viscosity_ratio;  ///< over the suspending fluid's
};

/// Viscosity of each of `rows` rows of a lattice over the suspending fluid's; empty without layers. A row that a border
/// cuts has the harmonic mean, by shares of its height: stress is the same on both sides, and slopes add up.
std::vector<double> viscosity_of_rows(const std::vector<Layer>& layers, int rows);

/// Relaxation rate 1/tau of a fluid that is `viscosity_ratio` times as viscous as one with `relaxation_rate`.
double rate_of_layer(double relaxation_rate, double viscosity_ratio);

/// Steady flow between walls of a fluid whose rows have these viscosities over `viscosity`: velocity and slope in the
/// middle of each row. Its stress is linear in y, and du/dy is the stress over the row's viscosity.
std::vector<ProfilePoint> layered_profile(const std::vector<double>& viscosity_of_rows, double viscosity,
                                          const WallVelocity& walls, double body_force_x);

/// Integral of the velocity along Domain::flow_axis over the cross-section (the height, in two dimensions), lattice
/// units, from its mean in each row. Between walls it is exact for velocities that are parabolas from wall to wall
/// (midpoint rule with its end correction; the walls' velocity counts as a value). `solid`: solid nodes are at the
/// walls, and there is no correction.
template <int D>
double flow_rate(const std::vector<double>& row_velocities, const WallVelocity& walls, const Domain<D>& domain,
                 bool solid = false);

}  // namespace rouleau::core
