// Errors as they were measured on lattices and in fluids that are simulated denser than they are, relative: docs/accuracy.md,
// "The error model of auto".
#pragma once

#include "scene/scene.hpp"

namespace rouleau::plan {

/// Errors were measured for cells whose inside is as viscous as the fluid around them, up to so many times as viscous.
inline constexpr double measured_ratio = 5;

/// The radius that a lattice must resolve, m: the smallest semi-axis; of a biconcave cell and of a surface from a file half the
/// length.
double resolved_radius(const scene::Shape& shape);

/// What a lattice leaves in the shape and the motion of a cell with this resolved radius, in spacings; tau is the fluid's largest
/// relaxation time.
double lattice_error(const scene::Shape& shape, double radius, double viscosity_ratio, double tau, int dimension,
                     bool slip_correction);

/// That error at this relaxation time over the one at tau 1.
double growth_of_lattice_error(double tau, int dimension);

/// What a lattice leaves in a steady flow that is driven through the domain: nothing between two planes.
double steady_flow_error(const scene::Domain& domain, double spacing);
/// What it leaves in the start of a flow without cells.
double flow_start_error(const scene::Domain& domain, double spacing, double tau);

/// Relative error of strains at which something happens, at this simulated Reynolds number.
double motion_error(double reynolds, int dimension);
/// What is left, at this Reynolds number and after this strain, of a cell's way to its steady state.
double steady_error(double reynolds, double strain, double viscosity_ratio, int dimension);

/// The power of the spacing with which the lattice's error was measured to fall: 2, and for biconcave cells with the fluid's own
/// viscosity inside 3; without slip correction 1.
double order_of_lattice_error(const scene::Scene& scene);

}  // namespace rouleau::plan
