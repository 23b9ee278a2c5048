// What a plan is to the solver: the setup of each stage.
#pragma once

#include <memory>

#include "core/fluid/solid_nodes.hpp"
#include "core/solver/solver_setup.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// The region of a scene's fluid on its lattice, the nodes outside of it, and the area of its walls, as a setup has
/// them: the same in all stages. Nothing where planes alone close the domain.
template <int D>
struct LatticeWalls {
  core::RegionPointer<D> region = {};
  std::shared_ptr<const core::SolidNodes<D>> solid = {};
  double area = 0;
  /// Of an inlet, the area that is open over that of its fluid nodes.
  double inlet_share = 1;
};
template <int D>
LatticeWalls<D> lattice_walls(const scene::Scene& scene);

/// All of stage `index` of a scene of D dimensions in lattice units. It shares the plan's models, and these walls.
template <int D>
core::BasicSolverSetup<D> make_solver_setup(const Plan& plan, int index, const LatticeWalls<D>& walls);
template <int D = 2>
core::BasicSolverSetup<D> make_solver_setup(const Plan& plan, int index) {
  return make_solver_setup<D>(plan, index, lattice_walls<D>(*plan.scene));
}

}  // namespace rouleau::plan
