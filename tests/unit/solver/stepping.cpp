// How workers wait for each other, cells that a solver does not take, and a force that drives the fluid.
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

#include "core/solver/barrier.hpp"
#include "core/solver/solver.hpp"
#include "unit/shipped_models.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

TEST_CASE("nobody leaves a barrier before all have come") {
  const int workers = GENERATE(1, 2, 5);
  constexpr int rounds = 2000;
  Barrier barrier(workers);
  std::vector<int> rounds_done(static_cast<std::size_t>(workers), 0);
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int w = 0; w < workers; ++w) {
    threads.emplace_back([&, w] {
      for (int round = 1; round <= rounds; ++round) {
        rounds_done[static_cast<std::size_t>(w)] = round;
        barrier.arrive_and_wait();
        for (const int done : rounds_done) wrong += done == round ? 0 : 1;
        const unsigned announced = barrier.arrive();
        // Nobody can be a round ahead before this one has waited.
        if (rounds_done[static_cast<std::size_t>(w)] != round) ++wrong;
        barrier.wait(announced);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}

TEST_CASE("a solver refuses cells whose type it has no laws for, or no state of rest") {
  Membranes cells;
  CHECK_THROWS_AS(add_cell(cells, 0, 8, 8, 0), std::out_of_range);
  cells.types = {std::make_shared<const RestShape>(make_rest_shape({3, 0, -3}, {0, 5, 0}))};
  add_cell(cells, 0, 8, 8, 0);
  SolverSetup setup;
  setup.domain = {{16, 16}, {true, true}};
  CHECK_THROWS_WITH(Solver<double>(setup, cells), "a cell is of a type that the setup does not have");
  setup.cell_types.resize(2);
  CHECK_THROWS_WITH(Solver<double>(setup, cells), "every cell type needs a state of rest");
}

namespace {

/// Velocity of every node before the next step; all are the same in a box without walls.
template <int D, class Solver>
std::array<double, D> velocity_of(Solver& solver) {
  solver.fluid().settle();
  const auto all = solver.fluid().all_moments();
  for (const auto& node : all) {
    for (int k = 0; k < D; ++k) CHECK(node.velocity[k] == Approx(all[0].velocity[k]).epsilon(1e-12).margin(1e-18));
  }
  return all[0].velocity;
}

}  // namespace

TEMPLATE_TEST_CASE("a driven fluid begins at rest, and has all of the force's momentum after each step", "", D2Q9,
                   D3Q19) {
  constexpr int D = TestType::dimension;
  BasicSolverSetup<D> setup;
  std::array<int, D> size;
  std::array<bool, D> periodic;
  size.fill(4), periodic.fill(true);
  setup.domain = {size, periodic};
  setup.inertia = GENERATE(false, true);
  setup.collision = trt(1, setup.inertia, D);
  setup.body_force_x = 1e-5, setup.body_force_y = -2e-5, setup.body_force_z = D == 3 ? 3e-5 : 0;
  const std::array<double, 3> force{setup.body_force_x, setup.body_force_y, setup.body_force_z};
  typename Solver<double, TestType>::Cells none;
  Solver<double, TestType> solver(setup, none);
  solver.start();
  for (int step = 0; step < 4; ++step) {
    const auto velocity = velocity_of<D>(solver);
    for (int k = 0; k < D; ++k) CHECK(velocity[k] == Approx(step * force[k]).epsilon(1e-12).margin(1e-19));
    solver.step(1);
  }
  // Another force goes on from the same velocity.
  BasicSolverSetup<D> reversed = setup;
  reversed.body_force_x *= -3, reversed.body_force_y = 0;
  Solver<double, TestType> later(reversed, none);
  later.start(&solver);
  for (int step = 0; step < 3; ++step) {
    const auto velocity = velocity_of<D>(later);
    CHECK(velocity[0] == Approx((4 - 3 * step) * force[0]).epsilon(1e-12));
    CHECK(velocity[1] == Approx(4 * force[1]).epsilon(1e-12));
    later.step(1);
  }
}
