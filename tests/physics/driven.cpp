// Flow driven by a pressure gradient: developed start, and cells that resist nothing.
#include <catch2/catch.hpp>
#include <cmath>

#include "scene_run.hpp"
#include "solver_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::plan;
using namespace rouleau::test;

namespace {

const std::vector<std::string> pressure_driven{R"(/stages/0/pressure_gradient="2e4 Pa/m")",
                                               R"(/stages/0/duration="0.02 s")"};

}  // namespace

TEST_CASE("a developed pressure-driven flow stays the parabola that it was started as", "[conservation]") {
  auto overrides = pressure_driven;
  overrides.insert(overrides.end(), {"/cells=[]", "/stages/0/start=developed", R"(/output/cells={"seconds": 0.002})"});
  const SceneRun run = run_scene(scenes + "/ring.json", overrides);
  REQUIRE(run.summary["status"] == "completed");
  const auto mach = run.series_column("mach_max");
  // Largest velocity G H^2 / (8 mu), in the two rows nearest to the middle.
  const double time_step = run.summary["conversions"][1]["si"], spacing = run.summary["conversions"][0]["si"];
  const double middle = 2e4 * 25.6e-6 * 25.6e-6 / (8 * 1.2e-3) * (1 - 1.0 / (128 * 128));
  // The start lacks the populations' second-order part: a transient of the order of spacing over height to the fourth.
  for (double m : mach) CHECK(m == Approx(middle * time_step / spacing * std::sqrt(3.0)).epsilon(std::pow(128.0, -4)));
}

TEST_CASE("cells without laws and with the fluid's viscosity do not change a driven flow", "[conservation]") {
  auto overrides = pressure_driven;
  overrides.emplace_back("/cell_types/ring/membrane=[]");
  SolverBench bench(scenes + "/ring.json", overrides);
  bench.start();
  FluidSetting setting = bench.solver->fluid().setting();
  setting.membranes = false;
  Fluid<double> alone(setting, make_collision("trt", {0.1875}, 1.0, false));
  bench.step(500);
  bench.forces();
  advance(alone, 500);
  auto& with_cells = bench.solver->fluid();
  with_cells.settle();
  alone.settle();
  double difference = 0, largest = 0;
  std::vector<Moments> a, b;
  for (int y = 0; y < 128; ++y) {
    with_cells.moments(y, a);
    alone.moments(y, b);
    for (std::size_t x = 0; x < a.size(); ++x) {
      difference = std::max(difference, std::hypot(a[x].ux - b[x].ux, a[x].uy - b[x].uy));
      largest = std::max(largest, std::abs(b[x].ux));
    }
  }
  CHECK(largest > 0);
  CHECK(difference < 1e-13 * largest);
}
