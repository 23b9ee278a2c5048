// The same bits from any number of ranks: whole simulations cut into blocks, cells shared out among owners.
#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <thread>

#include "core/solver/in_order.hpp"
#include "core/solver/solver.hpp"
#include "monitor/state_checks.hpp"
#include "observe/observer.hpp"
#include "plan/placed_cells.hpp"
#include "plan/solver_setup.hpp"
#include "unit/blocks_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

template <int D>
struct Planned {
  explicit Planned(const Case& c)
      : scene(plan::read_scene(c.file, c.overrides)), plan(plan::make_plan(scene, catalog())) {
    setup = plan::make_solver_setup<D>(plan, 0);
    cells = plan::make_cells<D>(scene);
  }
  scene::Scene scene;
  plan::Plan plan;
  BasicSolverSetup<D> setup;
  decltype(plan::make_cells<D>(scene)) cells;
};

/// What a rank is left with.
template <class T, class Set>
struct End {
  Domain<Set::dimension> domain;
  typename Solver<T, Set>::Cells cells;
  typename Solver<T, Set>::Cells seen;  ///< the same where it looks around
  std::vector<double> in_order;         ///< x of all nodes, on the first
  std::vector<std::uint64_t> observed;  ///< bits of what is observed in the end, on the first
  std::string failure;                  ///< what is said of the state; empty: it is sound
  std::vector<double> populations[Set::velocity_count];
};

/// Runs the steps with several workers.
template <class T, class Set>
void run(Solver<T, Set>& solver, long steps, int workers) {
  Barrier barrier(workers);
  std::vector<std::thread> threads;
  for (int w = 0; w < workers; ++w) {
    threads.emplace_back([&, w] {
      for (long i = 0; i < steps; ++i) {
        const StepPasses& step = solver.passes();
        step.run(0, step.rows, Worker{w, workers}, barrier);
        step.run(step.rows, step.passes.size(), Worker{w, workers}, barrier);
      }
      barrier.arrive_and_wait();
    });
  }
  for (std::thread& thread : threads) thread.join();
}

/// All numbers of a snapshot, by their bits.
std::vector<std::uint64_t> numbers(const observe::Snapshot& s) {
  std::vector<double> all{s.relative_viscosity,
                          s.shear_rate,
                          s.wall_stress_lower,
                          s.wall_stress_upper,
                          s.flow_rate,
                          s.mean_velocity,
                          s.mach_max,
                          s.cell_free_layer_lower,
                          s.cell_free_layer_upper,
                          s.cell_free_layer_empty,
                          s.particle_stress,
                          s.area_drift_max,
                          s.area_leakage_max,
                          s.mass_drift,
                          s.energy.kinetic,
                          s.energy.elastic,
                          s.energy.bending,
                          s.energy.interaction,
                          s.energy.total,
                          s.energy.viscous_dissipation,
                          s.energy.wall_power,
                          s.energy.membrane_dissipation};
  for (const observe::CellSnapshot& c : s.cells) {
    all.insert(all.end(), {double(c.cell), c.x, c.y, c.angle, c.deformation, c.area.value_or(NAN),
                           c.perimeter.value_or(NAN), c.tank_treading_angle, c.min_gap, c.wall_gap, double(c.aggregate),
                           double(c.through_image), c.stretch_min, c.stretch_max, c.z, c.volume, c.surface_area});
    all.insert(all.end(), c.semi_axes.begin(), c.semi_axes.end());
    all.insert(all.end(), c.short_axis.begin(), c.short_axis.end());
  }
  for (const observe::ContactSnapshot& c : s.contacts) {
    all.insert(all.end(), {double(c.cell_a), double(c.cell_b), double(c.image[0]), double(c.image[1]),
                           double(c.image[2]), c.gap, c.contact_length, c.contact_area});
  }
  for (const auto& [label, angle] : s.rotation) all.insert(all.end(), {double(label), angle});
  for (const observe::Field& field : s.membranes.fields)
    field.give([&](const std::vector<double>& values) { all.insert(all.end(), values.begin(), values.end()); });
  std::vector<std::uint64_t> bits;
  for (const double value : all) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

/// As far as ranks look around.
constexpr double sight = 9;

/// `look`: every so many steps, and in the end, ranks look around, and the first one hears of all cells.
template <class T, class Set>
End<T, Set> simulate(const Planned<Set::dimension>& planned, const Domain<Set::dimension>& domain,
                     const Ranks<Set::dimension>& ranks, const std::vector<int>& owner, long steps, int workers,
                     long look) {
  End<T, Set> end{.domain = domain,
                  .cells = planned.cells,
                  .seen = {},
                  .in_order = {},
                  .observed = {},
                  .failure = {},
                  .populations = {}};
  auto setup = planned.setup;
  setup.domain = domain;
  std::optional<GhostCells<Set::dimension>> ghosts;
  if (ranks.several()) {
    ghosts.emplace(ranks, boxes_of<Set::dimension>(end.cells), ghost_reach(setup), owner);
  }
  Solver<T, Set> solver(std::move(setup), end.cells, ranks, std::move(ghosts));
  solver.start();
  for (long done = 0; done < steps; done += look) {
    run(solver, std::min(look, steps - done), workers);
    {
      Surroundings<Set::dimension> around = solver.cell_tasks()->surroundings();
      around.show(sight);
      end.seen = end.cells;
    }
    end.in_order.clear();
    const auto add = [&](int c, std::vector<double>& x) {
      x.insert(x.end(), end.cells.position[0].begin() + end.cells.cells[c].first,
               end.cells.position[0].begin() + end.cells.cells[c].end());
    };
    give_in_order<double>(
        solver.cell_tasks()->ghosts(), end.cells, add,
        [&](Range, const std::vector<double>& x) { end.in_order.insert(end.in_order.end(), x.begin(), x.end()); }, 150);
  }
  REQUIRE_FALSE(solver.escaped());
  observe::Observer observer(planned.scene, planned.cells);
  const scene::StageSetting& setting = planned.plan.stages.front();
  solver.compute_forces();
  const auto observed = numbers(observer.observe(solver, setting, false));
  if (const auto failure = monitor::check_state(observer, solver, setting, planned.plan))
    end.failure = failure->message;
  if (ranks.first()) end.observed = observed;
  solver.fluid().settle();
  for (int q = 0; q < Set::velocity_count; ++q) solver.fluid().copy_populations(q, end.populations[q]);
  return end;
}

/// What the owner of a cell remembers of it.
void compare_memory(int c, const CellNodes& whole, const CellNodes& block) {
  const CellRange& cell = whole.cells[c];
  for (std::size_t k = 0; k < whole.state.size(); ++k) {
    const auto &of_whole = whole.state[k].value, &of_block = block.state[k].value;
    CHECK(std::equal(&of_whole[cell.first], of_whole.data() + cell.end(), &of_block[cell.first]));
  }
  for (const auto memory : {&CellNodes::contacts, &CellNodes::wall_contacts}) {
    if (!(whole.*memory).of_cell.empty()) {
      const std::vector<ContactState>&of_whole = (whole.*memory).of_cell[c], &of_block = (block.*memory).of_cell[c];
      REQUIRE(of_block.size() == of_whole.size());
      for (std::size_t k = 0; k < of_whole.size(); ++k) CHECK((of_block[k].value == of_whole[k].value));
    }
  }
}

template <class T, class Set>
void compare(const End<T, Set>& whole, const End<T, Set>& block) {
  const auto& size = whole.domain.size;
  const Box<Set::dimension>& box = block.domain.block;
  long different = 0;
  for (int q = 0; q < Set::velocity_count; ++q) {
    auto mine = block.populations[q].begin();
    for (int i = 0; i < row_count(box); ++i) {
      const auto row = row_of(box, i);
      std::ptrdiff_t at = 0;
      for (int k = Set::dimension - 1; k > 0; --k) at = at * size[k] + box.begin[k] + row[k - 1];
      auto expected = whole.populations[q].begin() + at * size[0] + box.begin[0];
      for (int x = 0; x < box.size(0); ++x) different += *mine++ != *expected++ ? 1 : 0;
    }
  }
  CHECK(different == 0);
  // Owners know all of their cells, and see those around them.
  const auto same = [&](const std::vector<double>& of_block, const std::vector<double>& of_whole, int begin, int end) {
    return of_whole.empty() || std::equal(of_whole.begin() + begin, of_whole.begin() + end, of_block.begin() + begin);
  };
  const auto boxes = boxes_of<Set::dimension>(whole.cells);
  for (int c = 0; c < block.cells.cell_count(); ++c) {
    const CellRange& cell = block.cells.cells[c];
    if (block.seen.knows(c)) {
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(same(block.seen.position[k], whole.cells.position[k], cell.first, cell.end()));
    }
    if (!block.cells.owns(c)) continue;
    for (int other = 0; other < block.cells.cell_count(); ++other) {
      if (distance_along_axes(boxes[c], boxes[other], whole.domain) <= sight) CHECK(block.seen.knows(other));
    }
    for (const auto arrays : {&CellNodes::position, &CellNodes::velocity, &CellNodes::force}) {
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(same((block.cells.*arrays)[k], (whole.cells.*arrays)[k], cell.first, cell.end()));
    }
    for (const auto values : {&CellNodes::largest_step, &CellNodes::area_leakage})
      CHECK(same(block.cells.*values, whole.cells.*values, c, c + 1));
    compare_memory(c, whole.cells, block.cells);
  }
  if (!block.in_order.empty()) CHECK((block.in_order == whole.cells.position[0]));
  if (!block.observed.empty()) CHECK((block.observed == whole.observed));
  CHECK(block.failure == whole.failure);
}

/// Each cell has one owner, whose block its middle is not far from.
template <class T, class Set>
void check_owners(const std::vector<End<T, Set>>& ends) {
  constexpr int D = Set::dimension;
  for (int c = 0; c < ends.front().cells.cell_count(); ++c) {
    int owners = 0;
    for (const End<T, Set>& end : ends) {
      if (!end.cells.owns(c)) continue;
      ++owners;
      const BoundingBox<D> box = box_of<D>(end.cells, c);
      BoundingBox<D> middle;
      for (int k = 0; k < D; ++k) middle.least[k] = middle.most[k] = (box.least[k] + box.most[k]) / 2;
      bool near = false;
      // A margin of 4, and a skin of 1 until owners are looked at again.
      for_nodes_near(middle, 5, 1, end.domain,
                     [&](const Box<D>& nodes) { near = near || nodes.meets(end.domain.block); });
      CHECK(near);
    }
    CHECK(owners == 1);
  }
}

template <class T, class Set>
void compare_cuts(const Case& c, const std::vector<Cut<Set::dimension>>& cuts, const Planned<Set::dimension>& planned,
                  long steps, long look, bool travel) {
  const End<T, Set> whole = simulate<T, Set>(planned, planned.setup.domain, {}, {}, steps, 1, look);
  for (const Cut<Set::dimension>& cut : cuts) {
    CAPTURE(c.what, cut.what, cut.owner);
    std::vector<End<T, Set>> ends(static_cast<std::size_t>(cut.blocks.ranks()));
    on_all_ranks(cut.blocks, [&](const Ranks<Set::dimension>& ranks) {
      const int rank = ranks.transport->rank();
      ends[rank] = simulate<T, Set>(planned, cut.blocks.domain(rank), ranks, cut.owner, steps, cut.threads, look);
    });
    for (const End<T, Set>& block : ends) compare(whole, block);
    if (travel) check_owners(ends);
  }
}

/// `look`: every so many steps all ranks tell each other everything. `cuts`: none: some of all; else cells travel over them,
/// and change hands.
template <class Set>
void compare_cuts(const Case& c, long steps, long look = 1000, std::vector<Cut<Set::dimension>> cuts = {}) {
  const bool travel = !cuts.empty() && steps > look;
  const Planned<Set::dimension> planned(c);
  if (cuts.empty()) cuts = some_cuts_of(planned.setup.domain, planned.cells.cell_count());
  if (planned.scene.numerics.precision == scene::Precision::f64) {
    compare_cuts<double, Set>(c, cuts, planned, steps, look, travel);
  } else {
    compare_cuts<float, Set>(c, cuts, planned, steps, look, travel);
  }
}

}  // namespace

TEST_CASE("any blocks give the same bits as the whole lattice") {
  for (const Case& c : scenes_to_cut()) compare_cuts<D2Q9>(c, block_steps(20));
}

TEST_CASE("any blocks give the same bits while cells come and go") {
  // Cells travel so far that ranks get to know them and forget them again.
  for (const Case& c : travelling_cells())
    compare_cuts<D2Q9>(c, block_steps(700), 450, cuts_for_travellers(Planned<2>(c).setup.domain));
}

TEST_CASE("any blocks give the same bits while cells come and go in three dimensions") {
  const Case c = travelling_in_space();
  compare_cuts<D3Q19>(c, block_steps(180), 90, cuts_for_travellers(Planned<3>(c).setup.domain));
}

TEST_CASE("any blocks give the same bits as the whole lattice in three dimensions") {
  for (const Case& c : scenes_in_space()) compare_cuts<D3Q19>(c, block_steps(12));
}
