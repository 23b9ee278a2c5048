// Errors as they were measured on lattices and in fluids that are simulated denser than they are, relative:
// docs/accuracy.md, "The error model of auto".
#pragma once

#include "constants.hpp"
#include "scene/scene.hpp"

namespace rouleau::plan {

/// Es/(mu a) of a scene's cells, 1/s: shear rates over it are capillary numbers. Es is a third of the stretching
/// stiffness, as of a neo-Hookean membrane.
struct RecoveryRates {
  double least, most;
  bool operator==(const RecoveryRates&) const = default;
};
/// The radius that a lattice must resolve, m: the smallest semi-axis; of a biconcave cell and of a surface from a file
/// half the length.
double resolved_radius(const scene::Shape& shape);

/// How membranes are coupled to the lattice, as far as errors were measured for it.
enum class MembraneCoupling {
  plain,
  corrected,  ///< with the slip correction
  sharp       ///< and with the kernel sharp6
};
MembraneCoupling membrane_coupling(const scene::Numerics& numerics);
LeastRadii least_radii(const scene::Scene& scene, MembraneCoupling coupling);

/// What a lattice leaves in the shape and the motion of a cell with this resolved radius, in spacings; tau is the
/// fluid's largest relaxation time.
double lattice_error(const scene::Shape& shape, double radius, double viscosity_ratio, double tau, int dimension,
                     MembraneCoupling coupling, const CapillaryRange& capillary);
/// What it leaves in the distance of cells that pass each other, over that distance.
double passing_error(double radius, int dimension, MembraneCoupling coupling);
/// What the membranes of round cells make of the lattice's fluid in two dimensions: it gives way to the pressure Es/a
/// by the share `compression`, 3 Es/a in lattice units or (tau - 1/2) times the shear rate in a step over the capillary
/// number, and with its inertia stiff cells then deform too much.
double stiffness_error(double compression, double reynolds, double viscosity_ratio);

/// What a lattice leaves at this relaxation time, over what it leaves at tau 1.
double growth_of_lattice_error(const scene::Scene& scene, double tau);

/// What a lattice leaves in a steady flow that is driven through the domain: nothing between two planes.
double steady_flow_error(const scene::Domain& domain, double spacing);
/// What it leaves in the start of a flow without cells.
double flow_start_error(const scene::Domain& domain, double spacing, double tau);

/// Relative error of strains at which something happens to a scene's cells, at this simulated Reynolds number.
double motion_error(double reynolds, const scene::Scene& scene);
/// A cell on its way to a steady state, in two dimensions between walls.
struct SteadyApproach {
  double reynolds, strain, viscosity_ratio;
  double height;         ///< of the channel, over the cell's radius
  double area_fraction;  ///< of all cells
  double capillary;
};
/// What the fluid's inertia leaves there, in shapes, angles and the relative viscosity: walls feel a cell late, and it
/// feels them.
double steady_error(const SteadyApproach& approach);
/// The same in three dimensions.
double steady_error_in_space(double reynolds, double strain, double viscosity_ratio);

/// The power of the spacing with which the lattice's error was measured to fall: 2, and for biconcave cells with the
/// fluid's own viscosity inside 3; without slip correction 1.
double order_of_lattice_error(const scene::Scene& scene);

}  // namespace rouleau::plan
