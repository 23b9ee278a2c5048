// The fluid alone in three dimensions: against exact flows, and against the two-dimensional lattice.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <iostream>
#include <numbers>

#include "core/fluid/developed_flow.hpp"
#include "flow_fixture.hpp"
#include "scene/driving_flow.hpp"
#include "study/exact_flow.hpp"

using namespace rouleau::core;
using namespace rouleau;
using namespace rouleau::study;
using namespace rouleau::test;

namespace {

using std::numbers::pi;
using Fluid3 = Fluid<double, D3Q19>;

double order(double coarse, double fine, double refinement = 2) {
  return std::log(coarse / fine) / std::log(refinement);
}

/// Flow rate of a square duct at rest before, after its flow has come to be, in units of G H^4 / mu.
double duct_flow_rate(int n, double tau) {
  const double viscosity = (tau - 0.5) / 3, force = 1e-6;
  const FluidSetting<3> setting{
      .domain = {{4, n, n}, {true, false, false}}, .relaxation_rate = 1 / tau, .body_force = {force}};
  Fluid3 fluid(setting, make_collision("trt", {0.1875}, tau, false, 3));
  // The slowest part of what is missing dies out as exp(-2 pi^2 viscosity t / n^2).
  advance(fluid, std::lround(20 * n * n / (2 * pi * pi * viscosity)));
  fluid.settle();
  return flow_rate(fluid.row_velocities(), {}, setting.domain) * viscosity / (force * std::pow(n, 4));
}

}  // namespace

TEST_CASE("the flow rate of a square duct is that of the series, to second order, and TRT's does not depend on tau",
          "[flow]") {
  constexpr double exact = 0.0351443;  // of G H^4 / mu: White, Viscous Fluid Flow, section 3-3
  std::vector<double> errors;
  for (int n : {8, 16, 32}) errors.push_back(std::abs(duct_flow_rate(n, 1.2) / exact - 1));
  std::cout << "square duct, tau 1.2: relative errors of the flow rate " << errors[0] << " " << errors[1] << " "
            << errors[2] << ", orders " << order(errors[0], errors[1]) << " " << order(errors[1], errors[2]) << "\n";
  CHECK(errors[2] < 1e-3);
  CHECK(order(errors[0], errors[1]) > 1.9);
  CHECK(order(errors[1], errors[2]) > 1.9);
  CHECK(duct_flow_rate(16, 0.6) == Approx(duct_flow_rate(16, 2)).epsilon(1e-6));
}

TEST_CASE("the series of ducts has the square's flow rate and goes over into that of a plane channel", "[flow]") {
  rouleau::scene::Domain domain{{1, 1, 1}, {4, 4, 4}, {}, {true, false, false}};
  CHECK(rouleau::scene::duct_share(domain) / 12 == Approx(0.0351443).epsilon(2e-6));
  domain.size[2] = 1e4;
  CHECK(rouleau::scene::duct_share(domain) == Approx(1).epsilon(1e-4));
  domain.periodic[2] = true;
  CHECK(rouleau::scene::duct_share(domain) == 1);
}

TEST_CASE("a flow in a plane, computed on four layers of D3Q19, is that of D2Q9 to rounding", "[flow]") {
  // Both relax every population, so that what D3Q19 has more averages out along z. A regularised collision keeps the
  // stress zz, which D2Q9 has not.
  const auto [collision, parameters] = GENERATE(std::pair{std::string("bgk"), std::vector<double>{}},
                                                std::pair{std::string("trt"), std::vector{0.1875}});
  const bool inertia = GENERATE(false, true);
  const double tau = 0.9;
  constexpr int nx = 24, ny = 15;
  const WallVelocity walls{-0.01, 0.02};
  const FluidSetting<2> plane_setting{.domain = {{nx, ny}, {true, false}},
                                      .relaxation_rate = 1 / tau,
                                      .inertia = inertia,
                                      .walls = walls,
                                      .body_force = {1e-5, -2e-6}};
  const FluidSetting<3> space_setting{.domain = {{nx, ny, 4}, {true, false, true}},
                                      .relaxation_rate = 1 / tau,
                                      .inertia = inertia,
                                      .walls = walls,
                                      .body_force = {1e-5, -2e-6, 0}};
  Fluid<double> plane(plane_setting, make_collision(collision, parameters, tau, inertia));
  Fluid3 space(space_setting, make_collision(collision, parameters, tau, inertia, 3));
  const auto u = [](int x, int y) { return 0.02 * std::sin(2 * pi * x / nx) * std::cos(0.7 * y); };
  const auto v = [](int x, int y) { return 0.01 * std::cos(4 * pi * x / nx) * std::sin(0.4 * y); };
  plane.set_state([&](int x, int y) { return Fluid<double>::State{1e-3 * u(y, x), {u(x, y), v(x, y)}, {}}; });
  space.set_state([&](int x, int y, int) { return Fluid3::State{1e-3 * u(y, x), {u(x, y), v(x, y), 0}, {}}; });
  advance(plane, 301);
  advance(space, 301);
  plane.settle();
  space.settle();
  const auto flat = plane.all_moments();
  const auto deep = space.all_moments();
  double difference = 0, across = 0, largest = 0;
  for (std::size_t i = 0; i < deep.size(); ++i) {
    const auto& expected = flat[i % flat.size()];
    for (int k = 0; k < 2; ++k) difference = std::max(difference, std::abs(deep[i].velocity[k] - expected.velocity[k]));
    across = std::max(across, std::abs(deep[i].velocity[2]));
    largest = std::max(largest, std::abs(expected.velocity[0]));
  }
  CAPTURE(collision, inertia);
  CHECK(largest > 1e-3);
  CHECK(difference < 1e-12 * largest);
  CHECK(across < 1e-12 * largest);
  CHECK(space.wall_stress().lower == Approx(plane.wall_stress().lower).epsilon(1e-10));
  CHECK(space.energetics().dissipation == Approx(4 * plane.energetics().dissipation).epsilon(1e-10));
}

namespace {

/// Relative error of a Beltrami flow, u = (sin kz + cos ky, sin kx + cos kz, sin ky + cos kx), which is its own curl:
/// it decays as exp(-viscosity k^2 t), with inertia and without.
double beltrami_error(const std::string& collision, const std::vector<double>& parameters, bool inertia, int n) {
  const double tau = 0.8, viscosity = (tau - 0.5) / 3, k = 2 * pi / n, speed = 0.2 / n;
  const FluidSetting<3> setting{
      .domain = {{n, n, n}, {true, true, true}}, .relaxation_rate = 1 / tau, .inertia = inertia};
  Fluid3 fluid(setting, make_collision(collision, parameters, tau, inertia, 3));
  const auto velocity = [&](int x, int y, int z) {
    return std::array{speed * (std::sin(k * z) + std::cos(k * y)), speed * (std::sin(k * x) + std::cos(k * z)),
                      speed * (std::sin(k * y) + std::cos(k * x))};
  };
  fluid.set_state([&](int x, int y, int z) {
    const auto u = velocity(x, y, z);
    const double s = speed * k, sx = s * std::sin(k * x), cx = s * std::cos(k * x), sy = s * std::sin(k * y),
                 cy = s * std::cos(k * y), sz = s * std::sin(k * z), cz = s * std::cos(k * z);
    // Pressure balances inertia where there is any: p + u^2/2 is the same everywhere, density deviation 3 p.
    const double square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    return Fluid3::State{
        inertia ? 1.5 * (3 * speed * speed - square) : 0, {u[0], u[1], u[2]}, {0, -sy, cz, cx, 0, -sz, -sx, cy, 0}};
  });
  const long steps = std::lround(0.5 / (viscosity * k * k));
  advance(fluid, steps);
  fluid.settle();
  const double decay = std::exp(-viscosity * k * k * static_cast<double>(steps));
  std::vector<double> value, exact;
  const auto moments = fluid.all_moments();
  for (int i = 0; i < n * n * n; ++i) {
    const auto u = velocity(i % n, i / n % n, i / n / n);
    for (int c = 0; c < 3; ++c) {
      value.push_back(moments[static_cast<std::size_t>(i)].velocity[c] / speed);
      exact.push_back(u[c] * decay / speed);
    }
  }
  return relative_l2(value, exact);
}

}  // namespace

TEST_CASE("a Beltrami flow in three dimensions decays with second order, with inertia and without", "[flow]") {
  const bool inertia = GENERATE(false, true);
  // Far from magic 1/6, where the leading error of diffusion vanishes and an order could not be measured.
  const auto [collision, parameters] =
      GENERATE(std::pair{std::string("bgk"), std::vector<double>{}}, std::pair{std::string("trt"), std::vector{0.5}},
               std::pair{std::string("mrt"), std::vector{1.64, 1.54, 0.0, 0.5}},
               std::pair{std::string("central-moment"), std::vector{1.0, 0.0, 1.0, 0.5}},
               std::pair{std::string("regularised"), std::vector<double>{}});
  std::vector<double> errors;
  for (int n : {12, 24, 48}) errors.push_back(beltrami_error(collision, parameters, inertia, n));
  std::cout << "Beltrami flow, " << collision << (inertia ? ", inertia" : ", Stokes") << ": relative L2 errors "
            << errors[0] << " " << errors[1] << " " << errors[2] << ", orders " << order(errors[0], errors[1]) << " "
            << order(errors[1], errors[2]) << "\n";
  CHECK(errors[2] < 2e-3);
  CHECK(order(errors[0], errors[2], 4) > 1.9);
  CHECK(order(errors[1], errors[2]) > 1.9);
}

namespace {

/// A shear wave u_along = sin(k wave . x), k one period of 32 nodes, that a stream carries in the direction of its
/// changes.
struct ShearWave {
  int along;
  std::array<int, 3> wave;
};

/// Relative error of the viscosity by which it decays in a stream of this speed.
double error_in_stream(const std::string& collision, const std::vector<double>& parameters, const ShearWave& shear,
                       double speed) {
  constexpr int n = 32;
  const double tau = 0.8, viscosity = (tau - 0.5) / 3, k = 2 * pi / n, height = 1e-4;
  std::array<int, 3> size{};
  int square = 0, count = 1;
  for (std::size_t b = 0; b < 3; ++b) {
    size[b] = shear.wave[b] != 0 ? n : 4;
    square += shear.wave[b] * shear.wave[b];
    count *= size[b];
  }
  const double rate = viscosity * k * k * square;
  const FluidSetting<3> setting{.domain = {size, {true, true, true}}, .relaxation_rate = 1 / tau, .inertia = true};
  Fluid3 fluid(setting, make_collision(collision, parameters, tau, true, 3));
  const auto phase = [&](int x, int y, int z) {
    return k * (shear.wave[0] * x + shear.wave[1] * y + shear.wave[2] * z);
  };
  fluid.set_state([&](int x, int y, int z) {
    Fluid3::State state{};
    state.velocity[shear.along] = height * std::sin(phase(x, y, z));
    for (int b = 0; b < 3; ++b) {
      const double share = shear.wave[static_cast<std::size_t>(b)];
      state.velocity[b] += speed * share / std::sqrt(square);
      state.gradient[3 * shear.along + b] = height * k * share * std::cos(phase(x, y, z));
    }
    return state;
  });
  const auto amplitude = [&] {
    fluid.settle();
    std::complex<double> sum = 0;
    const auto moments = fluid.all_moments();
    for (int i = 0; i < count; ++i) {
      sum += moments[static_cast<std::size_t>(i)].velocity[shear.along] *
             std::polar(1.0, -phase(i % size[0], i / size[0] % size[1], i / size[0] / size[1]));
    }
    return std::abs(sum);
  };
  const long steps = std::lround(0.5 / rate);
  advance(fluid, steps / 4);
  const double before = amplitude();
  advance(fluid, steps);
  return std::log(before / amplitude()) / (rate * static_cast<double>(steps)) - 1;
}

}  // namespace

TEST_CASE("a stream across a shear wave changes its viscosity by -3 V^2 in space, but for central moments", "[flow]") {
  // As in two dimensions (collision.cpp), for every pair of directions.
  constexpr double speed = 0.1, whole = -3 * speed * speed;
  const auto [collision, parameters] =
      GENERATE(std::pair{std::string("bgk"), std::vector<double>{}},
               std::pair{std::string("mrt"), std::vector{1.64, 1.54, 0.0, 0.1875}},
               std::pair{std::string("central-moment"), std::vector{1.0, 0.0, 1.0, 0.1875}});
  const bool central = collision == "central-moment";
  const auto change = [&, &collision = collision, &parameters = parameters](const ShearWave& shear) {
    const double found =
        error_in_stream(collision, parameters, shear, speed) - error_in_stream(collision, parameters, shear, 0);
    std::cout << "viscosity in a stream of 0.1, D3Q19, " << collision << ", u_"
              << "xyz"[shear.along] << " along (" << shear.wave[0] << ' ' << shear.wave[1] << ' ' << shear.wave[2]
              << "): " << found << "\n";
    return found;
  };
  CAPTURE(collision);
  for (int along = 0; along < 3; ++along) {
    for (std::size_t b = 0; b < 3; ++b) {
      ShearWave shear{along, {}};
      shear.wave[b] = 1;
      if (static_cast<int>(b) != along) CHECK(change(shear) == Approx(central ? 0 : whole).margin(0.003));
    }
  }
  // D3Q19 has no moment xyz, which is half of what such a stream carries askew.
  CHECK(change({2, {1, 1, 0}}) == Approx(central ? whole / 2 : whole).margin(0.003));
}

TEST_CASE("in three dimensions developed Couette flow stays, its wall stress is viscosity times shear rate, mass stays",
          "[flow]") {
  const double tau = 1.1, rate = 1e-4, mean = GENERATE(0.0, 0.02);
  constexpr int n = 12;
  const double middle = (n - 1) / 2.0, viscosity = (tau - 0.5) / 3;
  const FluidSetting<3> setting{.domain = {{6, n, 5}, {true, false, true}},
                                .relaxation_rate = 1 / tau,
                                .walls = {mean - rate * n / 2, mean + rate * n / 2}};
  Fluid3 fluid(setting, make_collision("trt", {0.1875}, tau, false, 3));
  fluid.set_profile([&](double y) { return mean + rate * (y - middle); }, [&](double) { return rate; });
  for (int steps : {0, 1, 2, 501}) {
    advance(fluid, steps);
    fluid.settle();
    const auto rows = fluid.row_velocities();
    for (int i = 0; i < 5 * n; ++i)
      CHECK(rows[static_cast<std::size_t>(i)] == Approx(mean + rate * (i % n - middle)).margin(1e-14));
    CHECK(fluid.wall_stress().lower == Approx(viscosity * rate).epsilon(1e-9));
    CHECK(fluid.wall_stress().upper == Approx(-viscosity * rate).epsilon(1e-9));
    CHECK(fluid.mass() == Approx(0).margin(1e-13 * 6 * 5 * n));
  }
}
