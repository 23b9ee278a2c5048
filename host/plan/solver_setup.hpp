// What a scene and its plan are to the solver: lattice, and the setup of each stage.
#pragma once

#include <memory>
#include <vector>

#include "core/solver/solver_setup.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// All of stage `index` of a scene of D dimensions in lattice units, with instances of its active models. Throws Error(plugin_refused) for a model
/// that cannot be made.
template <int D = 2>
core::BasicSolverSetup<D> make_solver_setup(const Plan& plan, int index);

}  // namespace rouleau::plan
