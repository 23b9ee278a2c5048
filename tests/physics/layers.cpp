// Flows of a fluid whose viscosity differs from layer to layer, against their exact solutions.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <iostream>
#include <numbers>

#include "scene_run.hpp"
#include "solver_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

using Complex = std::complex<double>;

/// Two fluids between walls at 0 and 1: viscosity 1 below the border, `ratio` above it.
struct TwoLayers {
  double border, ratio;

  /// Steady flow between a wall at rest and one that moves at 1 above it.
  [[nodiscard]] double couette(double y) const {
    const double stress = 1 / (border + (1 - border) / ratio);
    return y < border ? stress * y : 1 - stress * (1 - y) / ratio;
  }
  /// Steady flow between walls at rest under a force of 1.
  [[nodiscard]] double poiseuille(double y) const {
    // Stress s - y; the velocities of both parts agree at the border.
    const double b = border, s = (b * b / 2 + (1 - b * b) / (2 * ratio)) / (b + (1 - b) / ratio);
    return y < b ? s * y - y * y / 2 : ((1 - y * y) / 2 - s * (1 - y)) / ratio;
  }
  /// Amplitude where the upper wall oscillates with amplitude 1: i W^2 u = (mu u')', W^2 = omega H^2/nu below the
  /// border.
  [[nodiscard]] Complex oscillating(double womersley_square, double y) const {
    const Complex k = std::sqrt(Complex(0, womersley_square)), l = k / std::sqrt(ratio);
    // u = a sinh(k y) below, cosh(l (1 - y)) + c sinh(l (1 - y)) above; u and mu u' are the same at the border.
    const double h = 1 - border;
    const Complex below = std::sinh(k * border), below_stress = k * std::cosh(k * border);
    const Complex s = std::sinh(l * h), c = std::cosh(l * h);
    const Complex a = ratio * l / (below * ratio * l * c + below_stress * s);
    const Complex b = (a * below - c) / s;
    return y < border ? a * std::sinh(k * y) : std::cosh(l * (1 - y)) + b * std::sinh(l * (1 - y));
  }
};

enum class LayersDriven { by_wall, by_force };

struct Channel {
  TwoLayers layers;
  int rows;
  double tau = 1;
  bool developed = false;
  double womersley_square = 0;  ///< of the oscillation; 0: steady

  static constexpr double speed = 0.01;
  [[nodiscard]] double viscosity() const { return viscosity_of(tau); }
  [[nodiscard]] double omega() const { return womersley_square * viscosity() / rows / rows; }

  [[nodiscard]] Solver<double> start(LayersDriven driven, Membranes& none) const {
    SolverSetup setup{.domain = {{4, rows}, {true, false}}, .tau = tau};
    setup.layers = {{layers.border * rows, 1.0 * rows, layers.ratio}};
    setup.developed = developed;
    if (womersley_square > 0) {
      setup.oscillation = {.walls = {0, speed}, .body_force_x = 0, .frequency = omega() / (2 * std::numbers::pi)};
    } else if (driven == LayersDriven::by_wall) {
      setup.walls = {0, speed};
    } else {
      setup.body_force_x = speed * viscosity() / rows / rows;
    }
    setup.collision = make_collision("trt", {0.1875}, tau, false);
    Solver<double> solver(std::move(setup), none);
    solver.start();
    return solver;
  }
};

/// Largest distance from a profile over its largest velocity.
template <class Exact>
double distance(Solver<double>& solver, const Channel& channel, Exact exact) {
  solver.compute_forces();
  const auto profile = column(solver.fluid(), 1);
  double error = 0, largest = 0;
  for (int y = 0; y < channel.rows; ++y) {
    const double wanted = exact((y + 0.5) / channel.rows);
    error = std::max(error, std::abs(profile[y].velocity[0] / Channel::speed - wanted));
    largest = std::max(largest, std::abs(wanted));
  }
  return error / largest;
}

double steady_error(const Channel& channel, LayersDriven driven, long steps) {
  Membranes none;
  Solver<double> solver = channel.start(driven, none);
  solver.step(steps);
  return distance(solver, channel, [&](double y) {
    return driven == LayersDriven::by_wall ? channel.layers.couette(y) : channel.layers.poiseuille(y);
  });
}

/// Time in which the slowest mode falls by exp(-30) at least.
long long_time(const Channel& channel) {
  const double slow = std::min(1.0, channel.layers.ratio) * channel.viscosity();
  return std::lround(3.1 * channel.rows * channel.rows / slow);
}

}  // namespace

TEST_CASE("flows of two layers become the exact ones to rounding where the border lies between two rows", "[layers]") {
  const LayersDriven driven = GENERATE(LayersDriven::by_wall, LayersDriven::by_force);
  const double ratio = GENERATE(0.2, 5.0, 100.0);
  const double border = GENERATE(0.5, 0.25);
  const Channel channel{{border, ratio}, 16};
  CHECK(steady_error(channel, driven, long_time(channel)) < 1e-11);
}

TEST_CASE("the developed flow of layers is where it stays", "[layers]") {
  const LayersDriven driven = GENERATE(LayersDriven::by_wall, LayersDriven::by_force);
  const Channel channel{.layers = {0.25, 5}, .rows = 32, .tau = 0.8, .developed = true};
  CHECK(steady_error(channel, driven, 0) < 1e-12);
  CHECK(steady_error(channel, driven, 300) < 1e-4);
}

TEST_CASE("a row that the border of a layer cuts is off to first order, and no other row of a sheared fluid",
          "[layers]") {
  // 3/5 and 4/5 of a row below the border.
  double last = 1;
  for (const int rows : {12, 24, 48}) {
    Membranes none;
    const Channel channel{{(rows / 2 + (rows == 12 ? 0.6 : 0.8)) / rows, 5}, rows};
    Solver<double> solver = channel.start(LayersDriven::by_wall, none);
    solver.step(long_time(channel));
    const double error = distance(solver, channel, [&](double y) { return channel.layers.couette(y); });
    const auto profile = column(solver.fluid(), 1);
    double elsewhere = 0;
    for (int y = 0; y < rows; ++y) {
      if (y == rows / 2) continue;
      elsewhere = std::max(
          elsewhere, std::abs(profile[y].velocity[0] / Channel::speed - channel.layers.couette((y + 0.5) / rows)));
    }
    std::cout << "two layers, border within a row, " << rows << " rows: error " << error << ", elsewhere " << elsewhere
              << "\n";
    CHECK(elsewhere < 1e-11);
    CHECK(error < 0.6 * last);
    last = error;
  }
  CHECK(last < 0.01);
}

TEST_CASE("layers that a wall shakes follow the exact solution to second order", "[layers]") {
  double errors[3];
  for (int i = 0; i < 3; ++i) {
    const Channel channel{.layers = {0.5, 4}, .rows = 12 << i, .womersley_square = 25};
    Membranes none;
    Solver<double> solver = channel.start(LayersDriven::by_wall, none);
    const double period = 2 * std::numbers::pi / channel.omega();
    double error = 0;
    long done = 0;
    for (const double phase : {8.0, 8.2, 8.45, 8.7}) {  // periods, when the start has died out
      const long at = std::lround(phase * period);
      solver.step(at - done);
      const Complex turn = std::exp(Complex(0, channel.omega() * static_cast<double>(at)));
      error = std::max(error, distance(solver, channel,
                                       [&](double y) { return (turn * channel.layers.oscillating(25, y)).imag(); }));
      solver.advance();
      done = at + 1;
    }
    errors[i] = error;
  }
  std::cout << "two layers, oscillating wall: errors " << errors[0] << " " << errors[1] << " " << errors[2] << "\n";
  CHECK(std::log2(errors[0] / errors[1]) > 1.95);
  CHECK(std::log2(errors[1] / errors[2]) > 1.95);
}

TEST_CASE("in three dimensions a layer that fills the domain is a fluid of its viscosity, with a capsule in it",
          "[layers][space]") {
  const std::string file = std::string(ROULEAU_SCENES) + "/../tests/physics/scenes/plain-capsule-3d.json";
  const std::vector<std::string> small{"/domain/nodes=[24, 24, 24]", R"(/numerics/precision="f64")",
                                       "/stages/0/strain=0.5", "/cell_types/capsule/triangles=320",
                                       R"(/cell_types/capsule/interior_viscosity="6 cP")"};
  auto layered = small, whole = small;
  layered.push_back(R"(/fluid/layers=[{"from": "0 um", "to": "24 um", "viscosity": "2.4 cP"}])");
  whole.push_back(R"(/fluid/viscosity="2.4 cP")");
  whole.push_back("/numerics/tau=1.5");
  const SceneRun one = run_scene(file, layered), other = run_scene(file, whole);
  REQUIRE(one.summary["steps"] == other.summary["steps"]);
  for (const char* column : {"deformation", "angle_rad", "volume_m3"}) {
    const std::vector<double> a = one.column(column), b = other.column(column);
    for (std::size_t i = 1; i < a.size(); ++i) CHECK(a[i] == Approx(b[i]).epsilon(1e-9));
  }
  CHECK(one.column("deformation").back() > 0.05);
}
