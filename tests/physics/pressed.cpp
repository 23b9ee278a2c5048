// Cells that are pressed into corners and slits stay inside of walls of any shape; one that does not is noticed.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <memory>

#include "core/geometry/faceted.hpp"
#include "core/geometry/formulas.hpp"
#include "core/solver/solver.hpp"
#include "flow_fixture.hpp"
#include "monitor/state_checks.hpp"
#include "plan/placed_cells.hpp"
#include "plan/read_scene.hpp"
#include "plan/solver_setup.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;
using Catch::Matchers::Contains;

namespace {

/// Counter-clockwise, in spacings.
RegionPointer<2> polygon(const std::vector<Vec<2>>& corners) {
  Border<2> border{corners, {}};
  const int n = static_cast<int>(corners.size());
  for (int i = 0; i < n; ++i) border.facets.push_back({i, (i + 1) % n});
  return std::make_shared<FacetedRegion<2>>(border);
}
RegionPointer<2> block(double left, double right, double low, double high) {
  return polygon({{left, low}, {right, low}, {right, high}, {left, high}});
}

/// The first stage of a scene, in a region.
template <int D>
struct Bench {
  using Set = std::conditional_t<D == 2, D2Q9, D3Q19>;
  Bench(const std::string& file, const std::vector<std::string>& overrides, const RegionPointer<D>& region)
      : scene(plan::read_scene(file, overrides)),
        plan(plan::make_plan(scene, plugins())),
        cells(plan::make_cells<D>(scene)) {
    auto setup = plan::make_solver_setup<D>(plan, 0);
    setup.region = region;
    setup.solid = std::make_shared<const SolidNodes<D>>(setup.domain.size, region);
    solver = std::make_unique<Solver<double, Set>>(std::move(setup), cells);
    solver->start();
  }
  /// Between cells and walls, region and planes; over all nodes.
  [[nodiscard]] double gap() const {
    const auto& setup = solver->setup();
    const auto walls = intersection<D>({setup.region, between_walls(setup.domain)});
    double least = INFINITY;
    for (int i = 0; i < cells.node_count(); ++i) {
      Vec<D> at;
      for (int k = 0; k < D; ++k) at[k] = cells.position[k][static_cast<std::size_t>(i)];
      least = std::min(least, walls->distance(at).value);
    }
    return least;
  }
  [[nodiscard]] double middle(int axis) const {
    const auto& places = cells.position[static_cast<std::size_t>(axis)];
    double sum = 0;
    for (const double place : places) sum += place;
    return sum / static_cast<double>(places.size());
  }
  [[nodiscard]] std::optional<monitor::Failure> check() {
    observe::Observer observer(scene, cells);
    return monitor::check_state<D>(observer, *solver, plan.stages[0], plan);
  }

  scene::Scene scene;
  plan::Plan plan;
  typename Solver<double, Set>::Cells cells;
  std::unique_ptr<Solver<double, Set>> solver;
};

/// So many steps, in which no node may go through a wall; then one is put there.
template <int D>
void press(const char* what, Bench<D>& bench, double near, int steps) {
  CAPTURE(what);
  double least = INFINITY;
  for (int step = 0; step < steps; step += 50) {
    bench.solver->step(50);
    REQUIRE_FALSE(bench.solver->cell_tasks()->beyond_wall());
    least = std::min(least, bench.gap());
    REQUIRE(least > 0);
  }
  std::cout << what << ": gap " << bench.gap() << " spacings, least " << least << ", middle at " << bench.middle(0)
            << ", " << bench.middle(1) << std::endl;
  CHECK(least < near);  // it is pressed
  CHECK_FALSE(bench.check());
  for (int k = 0; k < D; ++k) bench.cells.position[static_cast<std::size_t>(k)][7] = k == 0 ? 1.5 : 2;
  const auto found = bench.solver->cell_tasks()->beyond_wall();
  REQUIRE(found);
  CHECK(found->node == 7);
  CHECK(found->depth > 0.5);
  const auto failure = bench.check();
  REQUIRE(failure);
  CHECK(failure->reason == "crossing");
  CHECK(failure->cell == 0);
  CHECK(failure->value == found->depth);
  CHECK_THAT(failure->message, Contains("the membrane of cell 0 crosses a wall"));
  CHECK_THAT(failure->remedy, Contains("give the repulsion from walls more strength"));
}

const std::string ring = std::string(ROULEAU_PHYSICS_SCENES) + "/viscous-ring.json",
                  capsule = std::string(ROULEAU_PHYSICS_SCENES) + "/capsule-in-tube.json";
const std::string flow = R"(/stages=[{"name": "flow", "pressure_gradient": "5e5 Pa/m", "duration": "1 s"}])";

std::string held(const std::string& type, const std::string& depth) {
  return R"(/interactions=[{"between": [")" + type + R"(", "wall"], "model": "morse", "parameters": {"depth": ")" +
         depth + R"( J/m2", "zero_force_distance": "0.3 um"}}])";
}
std::string repelled(const std::string& type, const std::string& strength) {
  return R"(/interactions=[{"between": [")" + type +
         R"(", "wall"], "model": "repulsion", "parameters": {"strength": ")" + strength +
         R"( J/m2", "cutoff": "0.4 um"}}])";
}

/// Spacings of 0.2 um.
std::vector<std::string> ring_scene(const std::string& at, const std::string& interaction, const std::string& stage) {
  return {R"(/domain/size=["12.8 um", "8 um"])",
          "/domain/nodes=[64, 40]",
          R"(/cell_types/ring/shape={"circle": {"radius": "1.6 um"}})",
          "/cell_types/ring/segments=50",
          R"(/cells=[{"type": "ring", "at": [)" + at + "]}]",
          interaction,
          stage};
}
const std::string rest = R"(/stages=[{"name": "rest", "duration": "1 s"}])";

void press_in_plane(int steps) {
  // An acute corner, of which both walls draw the ring in.
  Bench<2> corner(ring, ring_scene(R"("6.35 um", "4 um")", held("ring", "3e-6"), rest),
                  polygon({{5, 19.5}, {55, 2}, {55, 37}}));
  press<2>("ring drawn into a corner", corner, 1.5, steps);
  // Flow through a slit of a third of the ring's diameter.
  Bench<2> slit(ring, ring_scene(R"("4.4 um", "4 um")", repelled("ring", "2e-5"), flow),
                outside_of(union_of<2>({block(32, 40, -9, 16.5), block(32, 40, 22.5, 49), block(-1, 3, -9, 5)})));
  press<2>("ring pressed into a slit", slit, 1.5, steps);
}

void press_in_space(int steps) {
  const auto in_space = [](const std::string& at, const std::string& interaction, const std::string& stage) {
    return std::vector<std::string>{
        R"(/domain={"size": ["9 um", "6 um", "6 um"], "nodes": [36, 24, 24], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}},
           "z": {"lower": {"wall": {}}, "upper": {"wall": {}}}})",
        R"(/cells=[{"type": "capsule", "at": [)" + at + "]}]", interaction, stage};
  };
  // Between two tilted planes and one across z.
  Bench<3> corner(capsule, in_space(R"("5.1 um", "3 um", "2 um")", held("capsule", "3e-6"), rest),
                  extruded(polygon({{3, 11.5}, {34, -1}, {34, 24}}), 2, 0.3, 40));
  press<3>("capsule drawn into a corner", corner, 1.5, steps);
  Bench<3> slit(
      capsule, in_space(R"("3 um", "3 um", "3 um")", repelled("capsule", "2e-5"), flow),
      extruded(outside_of(union_of<2>({block(20, 26, -9, 8.5), block(20, 26, 14.5, 40), block(-1, 3, -9, 4)})), 2, -20,
               50));
  press<3>("capsule pressed into a slit", slit, 1.5, steps);
}

}  // namespace

TEST_CASE("a cell that is pressed into a corner or into a slit never crosses a wall, and one that does is noticed",
          "[walls]") {
  press_in_plane(10000);
}

TEST_CASE("in three dimensions a cell that is pressed into a corner or into a slit never crosses a wall",
          "[space][walls]") {
  press_in_space(10000);
}

TEST_CASE("a cell that is pressed into a corner or a slit for 1e5 steps never crosses a wall", "[walls][weekly]") {
  press_in_plane(100000);
}

TEST_CASE("in three dimensions a cell that is pressed for 1e5 steps never crosses a wall", "[space][walls][weekly]") {
  press_in_space(100000);
}
