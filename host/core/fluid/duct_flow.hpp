// Steady flow along x through a section that walls enclose.
#pragma once

#include "walls.hpp"

namespace rouleau::core {

/// Velocity along x and its derivatives; lattice units.
struct SectionPoint {
  double velocity = 0, slope_y = 0, slope_z = 0;
};

/// Of a rectangular duct, between walls across y that may move along x, and walls across z at rest. Lattice units; y and z
/// count from the middle. White, Viscous Fluid Flow (2006), section 3-3; the walls' part is Laplace's equation in a rectangle.
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
