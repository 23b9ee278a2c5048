// Flows that oscillate between walls, against their exact solutions: Stokes layers and Womersley flow in two
// dimensions.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <iostream>
#include <numbers>

#include "scene_run.hpp"
#include "solver_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::plan;
using namespace rouleau::test;

namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

/// Which of the three oscillates.
enum class Driven { one_wall, both_walls, force };

/// Velocity over its scale between walls at y = 0 and 1, where the drive is sin(t): i W^2 u = u'' (+ W^2 for a force,
/// so that a fluid without viscosity has amplitude 1), W^2 = omega H^2/nu.
Complex exact_amplitude(Driven driven, double womersley_square, double y) {
  const Complex k = std::sqrt(Complex(0, womersley_square));
  if (driven == Driven::one_wall) return std::sinh(k * y) / std::sinh(k);
  const Complex between = std::cosh(k * (y - 0.5)) / std::cosh(k * 0.5);
  return driven == Driven::both_walls ? between : (1.0 - between) / Complex(0, 1);
}

struct Case {
  Driven driven;
  double tau, womersley_square;
  bool developed;
};

/// Largest distance of the velocity from the exact one, over its largest value, through a period that begins after
/// `periods`; n nodes across.
double error_of(const Case& c, int n, double periods) {
  const double nu = (c.tau - 0.5) / 3, omega = c.womersley_square * nu / n / n, speed = 0.2 / n;
  SolverSetup setup{.domain = {{4, n}, {true, false}}, .tau = c.tau};
  setup.oscillation.frequency = omega / (2 * pi);
  if (c.driven == Driven::one_wall) setup.oscillation.walls = {0, speed};
  if (c.driven == Driven::both_walls) setup.oscillation.walls = {speed, speed};
  if (c.driven == Driven::force) setup.oscillation.body_force_x = speed * omega;
  setup.developed = c.developed;
  setup.collision = make_collision("trt", {0.1875}, c.tau, false);
  Membranes none;
  Solver<double> solver(std::move(setup), none);
  solver.start();
  const double period = 2 * pi / omega;
  const long begin = std::lround(periods * period), stride = std::max(1L, std::lround(period / 16));
  solver.step(begin);
  double error = 0, largest = 0;
  for (long step = begin; static_cast<double>(step) < static_cast<double>(begin) + period; step += stride) {
    solver.compute_forces();
    const auto profile = column(solver.fluid(), 1);
    const Complex phase = std::exp(Complex(0, omega * static_cast<double>(step)));
    for (int y = 0; y < n; ++y) {
      const double exact = (phase * exact_amplitude(c.driven, c.womersley_square, (y + 0.5) / n)).imag();
      error = std::max(error, std::abs(profile[static_cast<std::size_t>(y)].velocity[0] / speed - exact));
      largest = std::max(largest, std::abs(exact));
    }
    solver.advance();
    solver.step(stride - 1);
  }
  return error / largest;
}

const char* name_of(Driven driven) {
  return driven == Driven::one_wall ? "one wall" : driven == Driven::both_walls ? "both walls" : "force";
}

}  // namespace

TEST_CASE("a flow that oscillates from its developed state on follows the exact solution to second order",
          "[oscillation]") {
  const Driven driven = GENERATE(Driven::one_wall, Driven::both_walls, Driven::force);
  const double tau = GENERATE(0.8, 1.3);
  // Layers a fifth of the height thick: W^2 = 2 (H/delta)^2.
  const Case c{driven, tau, 50, true};
  const double coarse = error_of(c, 16, 0), middle = error_of(c, 32, 0), fine = error_of(c, 64, 0);
  std::cout << "oscillating " << name_of(driven) << ", tau " << tau << ": errors " << coarse << " " << middle << " "
            << fine << ", orders " << std::log2(coarse / middle) << " " << std::log2(middle / fine) << "\n";
  CHECK(std::log2(coarse / middle) > 1.8);
  CHECK(std::log2(middle / fine) > 1.9);
  CHECK(fine < 2e-3);
}

TEST_CASE("an oscillation that begins in a fluid at rest settles to the developed one", "[oscillation]") {
  const Driven driven = GENERATE(Driven::one_wall, Driven::force);
  // The slowest mode falls by exp(-pi^2 t nu/H^2): by 1e-4 in six periods of W^2 = 40.
  const Case c{driven, 1.0, 40, false};
  const double rest = error_of(c, 24, 6), developed = error_of({driven, 1.0, 40, true}, 24, 6);
  std::cout << "oscillating " << name_of(driven) << " from rest, after six periods: error " << rest << ", developed "
            << developed << "\n";
  CHECK(rest == Approx(developed).margin(5e-4));
  CHECK(error_of(c, 24, 0) > 0.05);
}

TEST_CASE("at the limits of the plan for layers and periods the velocity is within 1 % of its amplitude",
          "[oscillation]") {
  // The thinner layer up to tau 1.04, and the shorter period above.
  const double tau = GENERATE(0.6, 1.0, 1.5, 2.0, 3.0);
  const double nu = (tau - 0.5) / 3, steps = std::max(pi * 2.5 * 2.5 / nu, 350 * (tau - 0.5) * (tau - 0.5));
  for (const Driven driven : {Driven::one_wall, Driven::both_walls, Driven::force}) {
    const double error = error_of({driven, tau, 2 * pi / steps * 24 * 24 / nu, true}, 24, 0);
    std::cout << "tau " << tau << ", layers of " << std::sqrt(nu * steps / pi) << " spacings, " << steps
              << " steps in a period, " << name_of(driven) << ": error " << error << "\n";
    CHECK(error < 0.01);
  }
}

TEST_CASE("wall stress and shear rate of a scene that oscillates have the exact ratio and phase", "[oscillation]") {
  // 20 um high, 1e-6 m2/s, 200 Hz with a fluid 4 times heavier: W^2 = 2.0; walls against each other.
  const SceneRun run =
      run_scene(scenes + "/capsule.json",
                {"/cells=[]", "/domain/size=[\"5 um\", \"20 um\"]", "/domain/nodes=[16, 64]",
                 "/fluid/viscosity=\"1 cP\"", "/numerics/density_factor=4", "/output/cells={\"seconds\": \"0.5 ms\"}",
                 R"(/stages=[{"name": "shake", "shear_rate": "5 1/s", "duration": "20 ms", "start": "developed",
                    "oscillation": {"amplitude": "50 1/s", "frequency": "200 Hz"}}])"});
  REQUIRE(run.summary["status"] == "completed");
  const double height = 20e-6, nu = 1e-6 / 4, omega = 2 * pi * 200, viscosity = 1e-3;
  const Complex k = std::sqrt(Complex(0, omega / nu)), ratio = k * height / 2.0 / std::tanh(k * height / 2.0);
  const double step = run.summary["simulated_time_s"].get<double>() / run.summary["steps"].get<double>();
  const auto time = run.series_column("time_s"), rate = run.series_column("shear_rate_1_per_s"),
             lower = run.series_column("wall_stress_lower_Pa"), upper = run.series_column("wall_stress_upper_Pa");
  double error = 0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const Complex phase = std::exp(Complex(0, omega * (time[i] - step / 2)));
    CHECK(rate[i] == Approx(5 + 50 * phase.imag()).margin(1e-6));
    const double exact = viscosity * (5 + (50.0 * ratio * phase).imag());
    error = std::max({error, std::abs(lower[i] - exact), std::abs(upper[i] + exact)});
  }
  std::cout << "oscillating shear: wall stress off by " << error / (viscosity * 50) << " of the viscous amplitude\n";
  CHECK(error < 2e-3 * viscosity * 50);
  CHECK(std::abs(ratio.imag()) > 0.1);  // there is a phase to be found
  // Four periods of |5 + 50 sin|: more than 4 x 50 x 2/pi of a period each, by (5/50)^2/2.
  CHECK(run.summary["strain"].get<double>() == Approx(0.02 * 50 * 2 / pi * (1 + 0.5 * 0.1 * 0.1)).epsilon(1e-4));
}

TEST_CASE("in a ramp of the shear rate the walls take the exact stress, and strain is the integral of the rate",
          "[oscillation]") {
  // 20 um high, 1e-6 m2/s, from -10 to 40 1/s in 40 ms with a fluid 4 times heavier: it follows after 1.6 ms.
  const SceneRun run = run_scene(
      scenes + "/capsule.json",
      {"/cells=[]", "/domain/size=[\"5 um\", \"20 um\"]", "/domain/nodes=[8, 32]", "/fluid/viscosity=\"1 cP\"",
       "/numerics/density_factor=4", "/output/cells={\"seconds\": \"1 ms\"}",
       R"(/stages=[{"name": "ramp", "shear_rate": {"from": "-10 1/s", "to": "40 1/s"}, "duration": "40 ms"}])"});
  REQUIRE(run.summary["status"] == "completed");
  const double height = 20e-6, nu = 1e-6 / 4, viscosity = 1e-3, growth = 50 / 0.04;
  const double step = run.summary["simulated_time_s"].get<double>() / run.summary["steps"].get<double>();
  const auto time = run.series_column("time_s"), rate = run.series_column("shear_rate_1_per_s"),
             relative = run.series_column("relative_viscosity"), upper = run.series_column("wall_stress_upper_Pa");
  int compared = 0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double wanted = -10 + growth * (time[i] - step / 2);
    CHECK(rate[i] == Approx(wanted).margin(1e-9 * 40));
    if (time[i] < 0.01) continue;
    // du/dt = nu d2u/dy2 with walls that speed up evenly: the slope there is the rate and growth H^2/(12 nu).
    const double slope = wanted + growth * height * height / (12 * nu);
    CHECK(-upper[i] == Approx(viscosity * slope).epsilon(2e-3));
    CHECK(relative[i] * rate[i] == Approx(slope).epsilon(2e-3));
    ++compared;
  }
  CHECK(compared >= 30);
  // 8 ms at 5 1/s in the mean, then 32 ms at 20 1/s.
  CHECK(run.summary["strain"].get<double>() == Approx(0.008 * 5 + 0.032 * 20).epsilon(1e-3));
}
