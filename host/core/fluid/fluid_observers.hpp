// What is measured of a block of the fluid between two steps, once it is settled and the next step's force has been
// spread.
#pragma once

#include <vector>

#include "any_fluid.hpp"
#include "fluid_halo.hpp"
#include "fluid_state.hpp"

namespace rouleau::core {

/// Moments, 1/tau, viscous stresses and populations of row i, x = 0..nx-1.
template <class T, class Set>
void copy_moments(const FluidState<T, Set>& state, int i, Moments<Set::dimension>* to);
template <class T, class Set>
void copy_relaxation_rates(const FluidState<T, Set>& state, int i, double* to);
template <class T, class Set>
void copy_stresses(const FluidState<T, Set>& state, int i, Stress<Set::dimension>* to);
template <class T, class Set>
void copy_population(const FluidState<T, Set>& state, int q, int i, double* to);

// Of the whole lattice: all ranks together.

/// In one sweep over the rows. `halo`: null without other ranks. `walls`: their speeds during the last step.
template <class T, class Set>
FluidMeasures<Set::dimension> measure(const FluidState<T, Set>& state, const Ranks<Set::dimension>& ranks,
                                      const FluidHalo<T, Set>* halo, const WallVelocity& walls, WantedMeasures wanted);
/// Fluid::row_velocities_without_membranes.
template <class T, class Set>
std::vector<double> row_velocities_without_membranes(const FluidState<T, Set>& state,
                                                     const Ranks<Set::dimension>& ranks);
/// AnyFluid::end_flows.
template <class T, class Set>
std::array<EndFlow, 2> end_flows(const FluidState<T, Set>& state, const Ranks<Set::dimension>& ranks);
/// AnyFluid::passed.
template <class T, class Set>
std::array<std::vector<double>, 2> passed(const FluidState<T, Set>& state, const Ranks<Set::dimension>& ranks);
/// AnyFluid::wall_forces, of walls that had these speeds.
template <class T, class Set>
WallForces<Set::dimension> wall_forces(const FluidState<T, Set>& state, const Ranks<Set::dimension>& ranks,
                                       const WallVelocity& walls);

}  // namespace rouleau::core
