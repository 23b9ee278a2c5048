// What a scene and its plan are to the solver: lattice, and the setup of each stage.
#pragma once

#include <memory>
#include <vector>

#include "core/solver/solver_setup.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// The lattice of a scene of D dimensions, in one block; with D = 2, of one of three, its section across z.
template <int D = 2>
core::Domain<D> lattice_domain(const scene::Scene& scene);

/// Its nodes in the walls of a tube; null: it is none.
std::shared_ptr<const core::SolidNodes<3>> solid_nodes(const scene::Scene& scene);

/// Its layers of other viscosities.
std::vector<core::Layer> lattice_layers(const scene::Scene& scene);

/// All of stage `index` of a scene of D dimensions in lattice units, with instances of its active models. Throws Error(plugin_refused) for a model
/// that cannot be made.
template <int D = 2>
core::BasicSolverSetup<D> make_solver_setup(const Plan& plan, int index);

}  // namespace rouleau::plan
