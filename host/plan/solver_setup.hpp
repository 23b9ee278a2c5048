// What a plan is to the solver: the setup of each stage.
#pragma once

#include "core/solver/solver_setup.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// All of stage `index` of a scene of D dimensions in lattice units. It shares the plan's models.
template <int D = 2>
core::BasicSolverSetup<D> make_solver_setup(const Plan& plan, int index);

}  // namespace rouleau::plan
