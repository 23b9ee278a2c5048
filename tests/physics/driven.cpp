// Flow driven by a pressure gradient: developed start, and cells that resist nothing.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numeric>

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

TEST_CASE("profiles are those of Poiseuille's flow, and hold what the cells enclose", "[conservation]") {
  auto overrides = pressure_driven;
  overrides.insert(overrides.end(), {"/stages/0/start=developed", R"(/output/cells={"seconds": 0.0005})",
                                     R"(/output/profiles={"axis": "y", "bins": 32})"});
  const bool with_cell = GENERATE(false, true);
  if (!with_cell) overrides.emplace_back("/cells=[]");
  const SceneRun run = run_scene(scenes + "/ring.json", overrides);
  REQUIRE(run.summary["status"] == "completed");
  const std::vector<double> place = run.profile("position_m"), velocity = run.profile("velocity_m_per_s"),
                            hematocrit = run.profile("hematocrit");
  REQUIRE(place.size() == 32);
  const double height = 25.6e-6, width = height / 32;
  double flow = 0, filled = 0;
  for (std::size_t k = 0; k < 32; ++k) {
    CHECK(place[k] == Approx((static_cast<double>(k) + 0.5) * width));
    flow += velocity[k] * width;
    filled += hematocrit[k] / 32;
    if (with_cell) continue;
    // G y (H - y) / (2 mu) over the bin; rows of the lattice hold the parabola of their middles.
    const double mean = 2e4 / (2 * 1.2e-3) * (place[k] * (height - place[k]) - width * width / 12);
    CHECK(velocity[k] == Approx(mean).epsilon(1e-3));
    CHECK(hematocrit[k] == 0);
  }
  // Means over the second half of the stage. The flow rate has a correction of the midpoint rule at the ends.
  const std::vector<double> mean = run.series_column("mean_velocity_m_per_s");
  const auto middle = mean.begin() + static_cast<std::ptrdiff_t>(mean.size() / 2);
  const double late = std::accumulate(middle, mean.end(), 0.0) / static_cast<double>(mean.end() - middle);
  CHECK(flow == Approx(late * height).epsilon(2e-4));
  const double area = with_cell ? run.column("area_m2").back() : 0;
  CHECK(filled == Approx(area / (51.2e-6 * 25.6e-6)).epsilon(1e-3).margin(1e-15));
}

TEST_CASE("a mean velocity without cells is kept by the gradient of Poiseuille's flow", "[conservation]") {
  const SceneRun run = run_scene(
      scenes + "/capsule.json",
      {"/cells=[]", R"(/domain/size=["2.4 um", "9.6 um"])", "/domain/nodes=[4, 16]", "/numerics/density_factor=1",
       R"(/output/cells={"seconds": "2 us"})",
       R"(/stages=[{"name": "flow", "mean_velocity": "-2 mm/s", "start": "developed", "duration": "10 us"}])"});
  REQUIRE(run.summary["status"] == "completed");
  for (const double rate : run.series_column("flow_rate_m2_per_s")) {
    // The start lacks the populations' second-order part, as above.
    CHECK(rate == Approx(-2e-3 * 9.6e-6).epsilon(std::pow(16.0, -4)));
  }
  const double gradient = -12 * 1.2e-3 * 2e-3 / (9.6e-6 * 9.6e-6);
  for (const double value : run.series_column("pressure_gradient_Pa_per_m"))
    CHECK(value == Approx(gradient).epsilon(1e-9));
}

TEST_CASE("the mean velocity of a channel is kept with cells in it, and the gradient tells their viscosity",
          "[conservation]") {
  // Two stiff viscous capsules of 8 um in a channel of 25.6 um, which the gradient alone would take 0.6 s to start.
  const std::string start = GENERATE(std::string("impulsive"), std::string("developed"));
  const auto run_with = [&](const std::string& drive, int threads) {
    return run_scene(
        scenes + "/capsule.json",
        {R"(/domain/size=["25.6 um", "25.6 um"])", "/domain/nodes=[64, 64]", "/cell_types/capsule/segments=63",
         R"(/cell_types/capsule/interior_viscosity="6 cP")", "/numerics/density_factor=800",
         R"(/cells=[{"type": "capsule", "at": ["7 um", "8 um"]}, {"type": "capsule", "at": ["19 um", "16 um"]}])",
         R"(/output/cells={"seconds": 0.01})",
         R"(/stages=[{"name": "flow", "start": ")" + start + "\", " + drive + "}]"},
        threads);
  };
  const double wanted = 0.2e-3, height = 25.6e-6;
  const SceneRun run = run_with(R"("mean_velocity": "0.2 mm/s", "duration": "0.4 s")", 2);
  REQUIRE(run.summary["status"] == "completed");
  const auto time = run.series_column("time_s"), rate = run.series_column("flow_rate_m2_per_s"),
             gradient = run.series_column("pressure_gradient_Pa_per_m"),
             viscosity = run.series_column("relative_viscosity");
  // T = H^2/(pi^2 nu) is 0.044 s.
  double late = 0, over = 0, viscosity_off = 0;
  const double alone = 12 * 1.2e-3 * wanted / (height * height);
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double off = rate[i] / height / wanted - 1;
    over = std::max(over, off);
    if (time[i] < 1.5 * 0.044) continue;
    late = std::max(late, std::abs(off));
    viscosity_off = std::max(viscosity_off, std::abs(gradient[i] / alone / viscosity[i] - 1));
  }
  std::cout << "mean velocity kept, start " << start << ": off by " << late << " after 1.5 T, at most " << over
            << " above; relative viscosity " << viscosity.back() << "\n";
  CHECK(late < 1e-3);
  CHECK(over < 1e-3);
  CHECK(viscosity_off < 1e-3);
  CHECK(viscosity.back() > 1.02);
  if (start == "developed") {
    const SceneRun one = run_with(R"("mean_velocity": "0.2 mm/s", "duration": "0.03 s")", 1),
                   two = run_with(R"("mean_velocity": "0.2 mm/s", "duration": "0.03 s")", 2);
    CHECK(one.series == two.series);
    CHECK(one.cells == two.cells);
  }
}

TEST_CASE("cells without laws and with the fluid's viscosity do not change a driven flow", "[conservation]") {
  auto overrides = pressure_driven;
  overrides.emplace_back("/cell_types/ring/membrane=[]");
  SolverBench bench(scenes + "/ring.json", overrides);
  bench.start();
  FluidSetting<2> setting = bench.solver->fluid().setting();
  setting.membranes = false;
  Fluid<double> alone(setting, make_collision("trt", {0.1875}, 1.0, false));
  bench.step(500);
  bench.forces();
  advance(alone, 500);
  auto& with_cells = bench.solver->fluid();
  with_cells.settle();
  alone.settle();
  double difference = 0, largest = 0;
  std::vector<Moments<2>> a, b;
  for (int y = 0; y < 128; ++y) {
    with_cells.moments(y, a);
    alone.moments(y, b);
    for (std::size_t x = 0; x < a.size(); ++x) {
      difference =
          std::max(difference, std::hypot(a[x].velocity[0] - b[x].velocity[0], a[x].velocity[1] - b[x].velocity[1]));
      largest = std::max(largest, std::abs(b[x].velocity[0]));
    }
  }
  CHECK(largest > 0);
  CHECK(difference < 1e-13 * largest);
}
