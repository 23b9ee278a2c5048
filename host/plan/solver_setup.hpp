// What a stage of a plan is to the solver.
#pragma once

#include "core/solver/solver_setup.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// The lattice of a scene, in one block.
core::Domain<2> lattice_domain(const scene::Scene& scene);

/// All of stage `index` in lattice units, with instances of its active models. Throws Error(plugin_refused) for a model
/// that cannot be made.
core::SolverSetup make_solver_setup(const Plan& plan, int index);

}  // namespace rouleau::plan
