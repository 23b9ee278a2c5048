// The same bits from any number of ranks: whole simulations cut into blocks, cells shared out among owners.
#include <catch2/catch.hpp>
#include <thread>

#include "core/solver/solver.hpp"
#include "plan/solver_setup.hpp"
#include "unit/blocks_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

struct Planned {
  explicit Planned(const Case& c)
      : scene(plan::read_scene(c.file, c.overrides)), plan(plan::make_plan(scene, catalog())) {
    setup = plan::make_solver_setup(plan, 0);
    membranes = plan::make_membranes(scene, plan::lattice_spacing(scene));
  }
  scene::Scene scene;
  plan::Plan plan;
  SolverSetup setup;
  Membranes membranes;
};

/// What a rank is left with.
template <class T>
struct End {
  Domain<2> domain;
  Membranes membranes;
  std::vector<T> populations[9];
};

/// Runs the steps with several workers.
template <class T>
void run(Solver<T>& solver, long steps, int workers) {
  Barrier barrier(workers);
  std::vector<std::thread> threads;
  for (int w = 0; w < workers; ++w) {
    threads.emplace_back([&, w] {
      for (long i = 0; i < steps; ++i) {
        const std::size_t rows = solver.rows_pass(), all = solver.passes().size();
        run_passes(solver.passes(), 0, rows, solver.bands(), Worker{w, workers}, barrier, nullptr);
        run_passes(solver.passes(), rows, all, solver.bands(), Worker{w, workers}, barrier, nullptr);
      }
      barrier.arrive_and_wait();
    });
  }
  for (std::thread& thread : threads) thread.join();
}

template <class T>
End<T> simulate(const Planned& planned, const Domain<2>& domain, const Ranks<2>& ranks, const std::vector<int>& owner,
                long steps, int workers) {
  End<T> end{.domain = domain, .membranes = planned.membranes, .populations = {}};
  SolverSetup setup = planned.setup;
  setup.domain = domain;
  Solver<T> solver(std::move(setup), end.membranes, ranks, owner);
  solver.start();
  run(solver, steps, workers);
  REQUIRE_FALSE(solver.escaped());
  solver.fluid().settle();
  for (int q = 0; q < 9; ++q) solver.fluid().copy_populations(q, end.populations[q]);
  return end;
}

template <class T>
void compare(const End<T>& whole, const End<T>& block) {
  const int width = whole.domain.size[0];
  const Box<2>& box = block.domain.block;
  long different = 0;
  for (int q = 0; q < 9; ++q) {
    for (int y = 0; y < box.size(1); ++y) {
      for (int x = 0; x < box.size(0); ++x) {
        const T mine = block.populations[q][y * box.size(0) + x];
        different += mine != whole.populations[q][(y + box.begin[1]) * width + x + box.begin[0]] ? 1 : 0;
      }
    }
  }
  CHECK(different == 0);
  // Every rank knows where all cells are; what they remember and carry, only their owner.
  CHECK((block.membranes.x == whole.membranes.x));
  CHECK((block.membranes.y == whole.membranes.y));
  CHECK((block.membranes.velocity_x == whole.membranes.velocity_x));
  CHECK((block.membranes.largest_step == whole.membranes.largest_step));
  for (int c = 0; c < whole.membranes.cell_count(); ++c) {
    if (!block.membranes.owns(c)) continue;
    const CellRange& cell = whole.membranes.cells[c];
    for (int i = cell.first; i < cell.end(); ++i) {
      different += block.membranes.force_x[i] != whole.membranes.force_x[i] ? 1 : 0;
      for (std::size_t k = 0; k < whole.membranes.state.size(); ++k) {
        different += block.membranes.state[k].value[i] != whole.membranes.state[k].value[i] ? 1 : 0;
      }
    }
    if (!whole.membranes.area_leakage.empty())
      CHECK(block.membranes.area_leakage[c] == whole.membranes.area_leakage[c]);
  }
  CHECK(different == 0);
}

template <class T>
void compare_cuts(const Case& c) {
  const Planned planned(c);
  const Domain<2> domain = planned.setup.domain;
  const long steps = block_steps(40);
  const End<T> whole = simulate<T>(planned, domain, {}, {}, steps, 1);
  for (const Cut& cut : cuts_of(domain, planned.membranes.cell_count())) {
    CAPTURE(c.what, cut.what, cut.owner);
    std::vector<End<T>> ends(static_cast<std::size_t>(cut.blocks.ranks()));
    on_all_ranks(cut.blocks, [&](const Ranks<2>& ranks) {
      const int rank = ranks.transport->rank();
      ends[rank] = simulate<T>(planned, cut.blocks.domain(rank), ranks, cut.owner, steps, cut.threads);
    });
    for (const End<T>& block : ends) compare(whole, block);
  }
}

}  // namespace

TEST_CASE("any blocks give the same bits as the whole lattice") {
  for (const Case& c : scenes_to_cut()) {
    if (c.what.find("f32") == std::string::npos) {
      compare_cuts<double>(c);
    } else {
      compare_cuts<float>(c);
    }
  }
}
