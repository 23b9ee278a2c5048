// Checks of the state of a run that go through all of its nodes, and whether a suspension at rest has gained energy.
#pragma once

#include <optional>

#include "core/domain/ranks.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "core/solver/any_solver.hpp"
#include "failure.hpp"
#include "observe/energy.hpp"
#include "observe/observer.hpp"
#include "plan/plan.hpp"

namespace rouleau::monitor {

/// The first check of the scene that the state fails, without its time: a value of the fluid that is no number, the
/// Mach number, membranes that cross walls of any shape, a cell's area or volume, the length of a segment or edge,
/// membranes that cross each other. `observer` has measured the fluid, and follows mass, Mach number and areas. All
/// ranks together, and all find the same.
template <int D>
std::optional<Failure> check_state(observe::Observer& observer, core::AnySolver<D>& solver,
                                   const core::FluidMeasures<D>& measured, const scene::StageSetting& setting,
                                   const plan::Plan& plan);
template <int D>
std::optional<Failure> check_state(observe::Observer& observer, core::AnySolver<D>& solver,
                                   const scene::StageSetting& setting, const plan::Plan& plan) {
  return check_state(observer, solver, observer.measure_fluid(solver.fluid(), setting, false), setting, plan);
}

/// The failure, at the fastest node, if energy in the present stage has grown by more than checks.energy_growth. Not
/// looked at where an interaction has a state: bonds that form bring energy of their own. All ranks ask together, and
/// get the same; the first one knows the energy.
template <int D>
std::optional<Failure> check_energy(const observe::EnergyHistory& energy, const core::CellNodes& cells,
                                    const core::Ranks<D>& ranks, const plan::Plan& plan,
                                    const scene::StageSetting& setting);

}  // namespace rouleau::monitor
