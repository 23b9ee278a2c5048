// What a step does to outlines in one way and to surfaces in another.
#pragma once

#include <memory>

#include "core/coupling/slip_correction.hpp"
#include "core/coupling/surface_slip.hpp"
#include "core/membrane/membrane_forces.hpp"
#include "core/surface/surface_forces.hpp"
#include "solver_setup.hpp"

namespace rouleau::core {

template <int D>
struct CellMethods;
template <>
struct CellMethods<2> {
  using Forces = MembraneForces;
  using Slip = SlipCorrection;
};
template <>
struct CellMethods<3> {
  using Forces = SurfaceForces;
  using Slip = SurfaceSlip;
};

/// The slip correction that a setup asks for; null: membranes slip.
std::unique_ptr<SlipCorrection> make_slip(const SolverSetup& setup, const Membranes& membranes);
std::unique_ptr<SurfaceSlip> make_slip(const BasicSolverSetup<3>& setup, const Surfaces& surfaces);

/// The membranes' forces; `slip`: the correction, or null.
MembraneForces make_forces(const SolverSetup& setup, Membranes& membranes, const SlipCorrection* slip);
SurfaceForces make_forces(const BasicSolverSetup<3>& setup, Surfaces& surfaces, const SurfaceSlip* slip);

/// What it takes to stretch all membranes by 0.1 % and to bend them by as much; of surfaces: to stretch them by 0.1 %
/// along x, the volume law left aside. Energies far below this are rounding. Lattice units.
double slight_energy(const SolverSetup& setup, const Membranes& membranes);
double slight_energy(const BasicSolverSetup<3>& setup, const Surfaces& surfaces);

}  // namespace rouleau::core
