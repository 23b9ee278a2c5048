// Cells that are not there: what is observed is that of a scene without them, to the bit, and numbers stay.
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "core/solver/solver.hpp"
#include "monitor/rest_watch.hpp"
#include "observe/cell_free_layer.hpp"
#include "observe/observer.hpp"
#include "observe/rheology.hpp"
#include "plan/placed_cells.hpp"
#include "plan/solver_setup.hpp"
#include "unit/blocks_fixture.hpp"
#include "unit/run_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const std::string space = ROULEAU_SCENES "/../tests/physics/scenes/plain-capsule-3d.json";

/// Cells 0 and 2 touch; cell 1 lies apart from them.
std::vector<std::string> overrides_in_plane(bool all) {
  const std::string middle = R"({"type": "rbc", "angle": "10 deg", "at": ["17 um", "6.2 um"]}, )",
                    cells = R"(/cells=[{"type": "rbc", "angle": "20 deg", "at": ["5 um", "4.6 um"]}, )" +
                            (all ? middle : std::string()) +
                            R"({"type": "rbc", "angle": "20 deg", "at": ["5 um", "7.7 um"]}])";
  return {driven,
          cells,
          R"(/domain/size=["25.088 um", "12.544 um"])",
          "/domain/nodes=[128, 64]",
          "/output={}",
          contrast,
          "/numerics/area_correction=true",
          "/numerics/slip_correction=true"};
}
std::vector<std::string> overrides_in_space(bool all) {
  const std::string middle = R"({"type": "capsule", "at": ["11 um", "6 um", "6 um"]}, )",
                    cells = R"(/cells=[{"type": "capsule", "at": ["4 um", "6 um", "3 um"]}, )" +
                            (all ? middle : std::string()) +
                            R"({"type": "capsule", "at": ["5 um", "6.4 um", "9 um"]}])";
  return {"/numerics/precision=\"f64\"",
          R"(/domain={"size": ["15 um", "12 um", "12 um"], "nodes": [40, 32, 32], )"
          R"("y": {"lower": {"wall": {}}, "upper": {"wall": {}}}})",
          R"(/stages=[{"name": "driven", "pressure_gradient": "1e6 Pa/m", "duration": "1 s"}])",
          "/output={}",
          "/cell_types/capsule/interior_viscosity=\"6 cP\"",
          "/numerics/area_correction=true",
          cells};
}

/// One rank knows and owns these cells and no others, of which nothing is to be read.
void leave(CellNodes& cells, const std::vector<int>& there, const std::vector<int>& owned) {
  cells.part.assign(cells.cells.size(), {});
  cells.known = there;
  for (const int c : there) cells.part[c] = {.owned = false, .known = true, .reaching = true, .inside = false};
  for (const int c : owned) cells.part[c].owned = true;
  for (const Range& nodes : cells.unknown_nodes()) {
    for (NodeArrays* arrays : {&cells.position, &cells.velocity, &cells.force}) {
      for (std::vector<double>& values : *arrays) {
        if (!values.empty()) std::fill(values.begin() + nodes.begin, values.begin() + nodes.end, nan);
      }
    }
  }
}

template <int D>
struct Observed {
  std::vector<double> numbers;  ///< of all but which cells are which
  std::vector<int> cells, labels, contacts, members;
};

/// The nodes move a little first, so that there are speeds. `absent`: cell 1 is not there.
template <class Set>
Observed<Set::dimension> observe_state(const std::vector<std::string>& overrides, bool absent) {
  constexpr int D = Set::dimension;
  const scene::Scene scene = plan::read_scene(D == 2 ? four_cells : space, overrides);
  const plan::Plan plan = plan::make_plan(scene, catalog());
  auto cells = plan::make_cells<D>(scene);
  if (absent) leave(cells, {0, 2}, {0, 2});
  observe::Observer observer(scene, cells);
  Solver<double, Set> solver(plan::make_solver_setup<D>(plan, 0), cells);
  solver.start();
  for (int step = 0; step < 4; ++step) solver.step();
  solver.compute_forces();
  CHECK(observer.fits(cells));
  const observe::Snapshot s = observer.observe(solver, plan.stages.front(), false);
  Observed<D> found;
  auto& all = found.numbers;
  all = {s.relative_viscosity,
         s.flow_rate,
         s.discharge_hematocrit,
         s.cell_free_layer_lower,
         s.cell_free_layer_empty,
         s.particle_stress,
         s.area_drift_max,
         s.area_leakage_max,
         s.energy.elastic,
         s.energy.bending,
         s.energy.interaction,
         s.energy.total,
         s.energy.membrane_dissipation,
         double(s.aggregate_count),
         s.aggregate_size_weight_mean,
         observe::Observer::momentum_residual<D>(cells, {}, solver.ranks())};
  for (const observe::CellSnapshot& c : s.cells) {
    all.insert(all.end(), {c.x, c.y, c.z, c.angle, c.deformation, c.area.value_or(0), c.volume, c.tank_treading_angle,
                           c.min_gap, c.wall_gap, c.stretch_min, c.stretch_max});
    found.cells.push_back(c.cell);
    found.labels.push_back(c.aggregate);
  }
  for (const observe::ContactSnapshot& c : s.contacts) {
    found.contacts.insert(found.contacts.end(), {c.cell_a, c.cell_b});
    all.push_back(c.gap);
  }
  for (const auto& [label, angle] : s.rotation) all.push_back(angle);
  for (const observe::Field& field : s.membranes.fields) {
    const std::vector<double> values = whole(field);
    all.insert(all.end(), values.begin(), values.end());
  }
  found.members = s.membranes.cell;
  CHECK(s.membranes.first.size() == found.members.size() + 1);
  CHECK(static_cast<std::size_t>(s.membranes.first.back()) * D == whole(s.membranes.fields.front()).size());
  return found;
}

template <class Set>
void compare(const std::vector<std::string>& with, const std::vector<std::string>& without) {
  const auto absent = observe_state<Set>(with, true), never = observe_state<Set>(without, false);
  CHECK(absent.cells == std::vector{0, 2});
  CHECK(absent.members == std::vector{0, 2});
  CHECK(never.cells == std::vector{0, 1});
  const auto renumbered = [](std::vector<int> cells) {
    for (int& cell : cells) cell = cell == 1 ? 2 : cell;
    return cells;
  };
  CHECK(absent.labels == renumbered(never.labels));
  CHECK(absent.contacts == renumbered(never.contacts));
  REQUIRE(absent.numbers.size() == never.numbers.size());
  for (std::size_t k = 0; k < never.numbers.size(); ++k) {
    CAPTURE(k);
    CHECK(std::bit_cast<std::uint64_t>(absent.numbers[k]) == std::bit_cast<std::uint64_t>(never.numbers[k]));
  }
}

}  // namespace

TEST_CASE("a cell that is not there leaves no trace in what is observed, in two dimensions") {
  compare<D2Q9>(overrides_in_plane(true), overrides_in_plane(false));
}

TEST_CASE("a cell that is not there leaves no trace in what is observed, in three dimensions") {
  compare<D3Q19>(overrides_in_space(true), overrides_in_space(false));
}

TEST_CASE("sums and extremes over the cells of all ranks pass over one that no rank knows") {
  const scene::Scene scene = plan::read_scene(four_cells, overrides_in_plane(true));
  const core::Domain<2> domain = scene::lattice_domain<2>(scene);
  auto given = plan::make_cells<2>(scene);
  const observe::Observer at_start(scene, given);
  for (int i = 0; i < given.node_count(); ++i) {
    given.velocity[0][i] = 1e-3 * std::sin(i), given.velocity[1][i] = 1e-3 * std::cos(3 * i);
    given.force[0][i] = std::sin(5 * i), given.position[1][i] += given.velocity[1][i];
  }
  using Numbers = std::array<double, 5>;
  const auto measure = [&](const Membranes& cells, const Ranks<2>& ranks) {
    observe::Observer observer = at_start;
    int worst = -1;
    const double drift = observer.follow_area(cells, ranks, &worst);
    return Numbers{drift, double(worst), observe::Observer::momentum_residual<2>(cells, {}, ranks),
                   observe::cell_flux(cells, ranks), observe::cell_free_layer(cells, domain, ranks).lower};
  };
  Membranes without = given;
  leave(without, {0, 2}, {0, 2});
  const Numbers expected = measure(without, {});
  CHECK(expected[1] >= 0);
  CHECK(expected != measure(given, {}));
  const auto cut = Decomposition<2>::even(domain, {2, 1});
  on_all_ranks(cut, [&](const Ranks<2>& ranks) {
    Membranes mine = given;
    leave(mine, {0, 2}, {ranks.transport->rank() == 0 ? 0 : 2});
    const Numbers found = measure(mine, ranks);
    for (std::size_t k = 0; k < (ranks.first() ? found.size() : found.size() - 1); ++k) CHECK(found[k] == expected[k]);
  });
}

TEST_CASE("a cell that comes later begins with its own area and angle, and goes on with them after a restart") {
  const scene::Scene scene = plan::read_scene(four_cells, overrides_in_plane(true));
  const auto whole = plan::make_cells<2>(scene);
  auto cells = whole;
  leave(cells, {0, 2}, {0, 2});
  observe::Observer observer(scene, cells);
  cells = whole;
  for (int i = cells.cells[1].first; i < cells.cells[1].end(); ++i) cells.position[0][i] *= 1.25;  // another area
  observer.begin_with(cells, 1, 1);
  CHECK(observer.follow_area(cells, Ranks<2>{}) == 0);
  for (int i = cells.cells[1].first; i < cells.cells[1].end(); ++i) cells.position[1][i] *= 1.1;
  const std::vector<std::uint8_t> kept = nlohmann::json::to_cbor(observer);
  observe::Observer restored(scene);
  nlohmann::json::from_cbor(kept).get_to(restored);
  CHECK(restored.fits(cells));
  for (observe::Observer* each : {&observer, &restored}) {
    int worst = -1;
    CHECK(each->follow_area(cells, Ranks<2>{}, &worst) == Approx(0.1));
    CHECK(worst == 1);
  }
  CHECK(nlohmann::json::to_cbor(restored) == nlohmann::json::to_cbor(observer));
  observe::Observer of_two(scene);
  auto early = whole;
  leave(early, {0}, {0});
  of_two.begin_with(early, 0, 0);
  CHECK(of_two.fits(early));
  CHECK_FALSE(of_two.fits(whole));
}

TEST_CASE("who comes or leaves within a window of rest has moved") {
  const scene::Scene scene = plan::read_scene(four_cells, overrides_in_plane(true));
  const auto whole = plan::make_cells<2>(scene);
  auto fewer = whole;
  leave(fewer, {0, 2}, {0, 2});
  monitor::RestWatch watch;
  const GhostCells<2>* const alone = nullptr;
  watch.start(0, fewer, alone);
  CHECK(watch.moved(fewer, alone) == 0);
  CHECK(watch.moved(whole, alone) > 1e6);
  fewer.position[1][0] += 0.25;
  CHECK(watch.moved(fewer, alone) == 0.25);
  watch.start(0, whole, alone);
  fewer.position[1][0] -= 0.25;
  CHECK(watch.moved(whole, alone) == 0);
  CHECK(watch.moved(fewer, alone) > 1e6);
}
