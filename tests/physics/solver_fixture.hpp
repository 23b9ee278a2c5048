// The solver of a scene's first stage, to be stepped by a test that changes the membranes first.
#pragma once

#include "core/solver/solver.hpp"
#include "flow_fixture.hpp"
#include "plan/placed_cells.hpp"
#include "plan/read_scene.hpp"
#include "plan/solver_setup.hpp"

namespace rouleau::test {

using namespace core;
using namespace plan;
using namespace scene;

struct SolverBench {
  explicit SolverBench(const std::string& file, const std::vector<std::string>& overrides = {})
      : scene(read_scene(file, overrides)),
        plan(make_plan(scene, plugins())),
        membranes(make_cells<2>(scene, lattice_spacing(scene))) {}

  /// To be called once the membranes are as they should start.
  void start() { solver = std::make_unique<Solver<double>>(make_solver_setup(plan, 0), membranes); }
  void step(long steps) { solver->step(steps); }
  void forces() { solver->compute_forces(); }

  Scene scene;
  Plan plan;
  Membranes membranes;
  std::unique_ptr<Solver<double>> solver;
};

}  // namespace rouleau::test
