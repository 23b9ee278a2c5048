// The same bits from any number of ranks: whole simulations cut into blocks, cells shared out among owners.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <thread>

#include "core/solver/solver.hpp"
#include "plan/placed_cells.hpp"
#include "plan/read_scene.hpp"
#include "plan/solver_setup.hpp"
#include "plugin/catalog.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// A scene, its cells moved so that some lie over the borders.
struct Case {
  const char* what;
  const char* file;
  std::vector<std::string> overrides = {};
  double move_x = 0, move_y = 0;
};

const char* const four_cells = ROULEAU_SCENES "/four-cells-shear.json";
const std::string shear = R"(/stages=[{"name": "shear", "shear_rate": "50 1/s", "strain": 5, "start": "developed"}])";
const std::string no_strain = "/output={}";
const std::string contrast = "/cell_types/rbc/interior_viscosity=\"6 cP\"";
const std::string bonds = R"(/interactions=[{"between": ["rbc", "rbc"], "model": "bridging", "parameters": {
  "site_density": "1e12 1/m2", "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.49 um", "on_rate": "200 1/s",
  "off_rate": "10 1/s", "cutoff": "1.5 um"}}])";

struct Planned {
  explicit Planned(const Case& c)
      : scene(plan::read_scene(c.file, c.overrides)), plan(plan::make_plan(scene, catalog())) {
    setup = plan::make_solver_setup(plan, 0);
    membranes = plan::make_membranes(scene, plan::lattice_spacing(scene));
    for (double& x : membranes.x) x += c.move_x;
    for (double& y : membranes.y) y += c.move_y;
  }
  static const plugin::Catalog& catalog() {
    static const plugin::Catalog all({ROULEAU_PLUGINS});
    return all;
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
std::vector<End<T>> simulate_ranks(const Planned& planned, const Decomposition<2>& cut, const std::vector<int>& owner,
                                   long steps, int workers) {
  const auto ends = make_loopback(cut.ranks());
  std::vector<End<T>> result(ends.size());
  std::vector<std::thread> threads;
  for (int rank = 0; rank < cut.ranks(); ++rank) {
    threads.emplace_back([&, rank] {
      result[rank] = simulate<T>(planned, cut.domain(rank), {&cut, ends[rank].get()}, owner, steps, workers);
    });
  }
  for (std::thread& thread : threads) thread.join();
  return result;
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

/// Cuts by bisection at random places.
Decomposition<2> random_cuts(const Domain<2>& domain, int cuts, std::mt19937& random) {
  std::vector<Box<2>> blocks{domain.block};
  while (cuts > 0) {
    Box<2>& block = blocks[std::uniform_int_distribution<std::size_t>(0, blocks.size() - 1)(random)];
    const int axis = std::uniform_int_distribution<int>(0, 1)(random);
    if (block.size(axis) < 2) continue;
    const int at = block.begin[axis] + std::uniform_int_distribution<int>(1, block.size(axis) - 1)(random);
    Box<2> upper = block;
    upper.begin[axis] = at;
    block.end[axis] = at;
    blocks.push_back(upper);
    --cuts;
  }
  return {domain, blocks};
}

/// ROULEAU_BLOCK_STEPS=2000 for a long look (docs/testing.md).
long steps() {
  const char* wanted = std::getenv("ROULEAU_BLOCK_STEPS");
  return wanted != nullptr ? std::strtol(wanted, nullptr, 10) : 40;
}

template <class T>
void compare_cuts(const Case& c) {
  const Planned planned(c);
  const Domain<2> domain = planned.setup.domain;
  const End<T> whole = simulate<T>(planned, domain, {}, {}, steps(), 1);
  auto random = generator(static_cast<unsigned>(std::random_device()()));
  const auto check = [&](const Decomposition<2>& cut, const std::vector<int>& owner, int workers) {
    for (const End<T>& block : simulate_ranks<T>(planned, cut, owner, steps(), workers)) compare(whole, block);
  };
  compare(whole, simulate<T>(planned, domain, {}, {}, steps(), 3));
  using Parts = std::array<int, 2>;
  for (const Parts parts : {Parts{2, 1}, Parts{1, 3}, Parts{4, 4}, Parts{8, 1}}) {
    CAPTURE(c.what, parts);
    check(Decomposition<2>::even(domain, parts), {}, parts[1] == 3 ? 2 : 1);
  }
  for (int trial = 0; trial < 2; ++trial) {
    const Decomposition<2> cut = random_cuts(domain, 2 + trial * 3, random);
    std::vector<int> owner;
    for (int i = 0; i < planned.membranes.cell_count(); ++i) {
      owner.push_back(std::uniform_int_distribution<int>(0, cut.ranks() - 1)(random));
    }
    CAPTURE(c.what, trial, owner);
    check(cut, owner, 1 + trial);
  }
}

}  // namespace

TEST_CASE("four cells in shear give the same bits from any blocks, in both precisions") {
  compare_cuts<double>({"four cells", four_cells, {shear, contrast}});
  compare_cuts<float>({"four cells, f32", four_cells, {shear, contrast}});
}

TEST_CASE("cells over periodic borders give the same bits from any blocks") {
  const std::string driven = R"(/stages=[{"name": "driven", "pressure_gradient": "2e4 Pa/m", "duration": "1 s"}])";
  compare_cuts<double>({"over x", four_cells, {shear, contrast}, 130, 0});
  compare_cuts<double>({"over x and y", four_cells, {driven, no_strain, contrast, "/domain/y=\"periodic\""}, -140, 60});
  compare_cuts<double>({"its own neighbour",
                        four_cells,
                        {shear, contrast, R"(/domain/size=["8.624 um", "25.088 um"])", "/domain/nodes=[44, 128]",
                         R"(/cells=[{"type": "rbc", "at": ["4 um", "12 um"]}])"}});
  compare_cuts<double>({"driven channel", four_cells, {driven, no_strain}, 100, 10});
}

TEST_CASE("corrections and the semi-implicit step give the same bits from any blocks") {
  compare_cuts<double>({"slip and area correction",
                        four_cells,
                        {shear, contrast, "/numerics/slip_correction=true", "/numerics/area_correction=true"},
                        100});
  compare_cuts<double>({"semi-implicit", four_cells, {shear, "/numerics/coupling=\"semi-implicit\""}});
}

TEST_CASE("laws and potentials that remember give the same bits from any blocks") {
  compare_cuts<double>({"memory", ROULEAU_PHYSICS_SCENES "/memory.json"});
  compare_cuts<double>({"viscous ring", ROULEAU_PHYSICS_SCENES "/viscous-ring.json"});
  compare_cuts<double>({"bonds", four_cells, {shear, bonds}, 110, 0});
}
