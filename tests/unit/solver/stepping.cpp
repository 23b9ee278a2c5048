// When something is due between two steps, how workers wait for each other, and cells that a solver does not take.
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

#include "core/solver/barrier.hpp"
#include "core/solver/solver.hpp"
#include "plan/output_schedule.hpp"

using namespace rouleau::plan;
using namespace rouleau::scene;
using namespace rouleau::core;

TEST_CASE("the next step of a schedule is the first one that is due") {
  StageSetting setting{};
  setting.units.time = 1;
  setting.shear_rate = 1;
  setting.max_steps = 1000;
  Cadence cadence;
  const double interval = GENERATE(1.0, 1.4, 1.5, 2.5, 7.3, 100.0);
  cadence.seconds = interval;
  if (interval == 7.3) cadence.strain = 4.9;
  const OutputSchedule schedule(cadence, setting, true);
  long next = schedule.next(0);
  for (long step = 1; step < 1000; ++step) {
    CAPTURE(interval, step);
    REQUIRE(schedule.due(step) == (step == next));
    if (step == next) next = schedule.next(step);
  }
}

TEST_CASE("a schedule without an interval is never due again") {
  StageSetting setting{};
  setting.max_steps = 1000;
  CHECK(OutputSchedule(Cadence{}, setting, true).next(0) == std::numeric_limits<long>::max());
}

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
