// Whether the state between two steps is sound, by what costs a scan of it.
#pragma once

#include <optional>

#include "core/solver/any_solver.hpp"
#include "failure.hpp"
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

}  // namespace rouleau::monitor
