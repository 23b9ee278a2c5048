// Developed flow along x, without cells: of a channel, and through a section that walls enclose.
#pragma once

#include <functional>

#include "walls.hpp"

namespace rouleau::core {

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

}  // namespace rouleau::core
