// Every collision operator in flows with exact solutions: its viscosity, its walls, layers of two viscosities.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <iostream>
#include <numbers>

#include "flow_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

using std::numbers::pi;

/// An operator with its parameters in the manifest's order, and the magic number (1/omega - 1/2)(1/s_odd - 1/2) that
/// its rate for odd moments amounts to.
struct Operator {
  std::string id;
  std::vector<double> parameters;
  double (*magic)(double tau);
  std::string name = id;
};

double of_equal_rates(double tau) { return (tau - 0.5) * (tau - 0.5); }
double of_rate_one(double tau) { return (tau - 0.5) / 2; }
double of_magic(double) { return 0.1875; }

/// The operators as a scene gets them when it sets nothing.
std::vector<Operator> shipped_operators() {
  return {{"bgk", {}, of_equal_rates},
          {"trt", {0.1875}, of_magic},
          {"mrt", {1.64, 1.54, 0, 0.1875}, of_magic},
          {"regularised", {}, of_rate_one},
          {"central-moment", {1, 0, 1, 0.1875}, of_magic}};
}

/// Far from magic 1/6, where the leading error of diffusion vanishes and an
/// order could not be measured.
std::vector<Operator> operators_of_other_magic() {
  return {{"bgk", {}, of_equal_rates},
          {"trt", {0.5}, nullptr},
          {"mrt", {1.64, 1.54, 0, 0.5}, nullptr},
          {"regularised", {}, of_rate_one},
          {"central-moment", {1, 0, 1, 0.5}, nullptr}};
}

/// Viscosity over (tau - 1/2)/3, minus 1: from the decay of a shear wave u = U sin(k y) on n rows, in a frame in which
/// the fluid moves with (drift, crossing).
double viscosity_error(const Operator& op, double tau, bool inertia, int n, double drift = 0, double crossing = 0) {
  const double nu = (tau - 0.5) / 3, k = 2 * pi / n, speed = 1e-4;
  FluidSetting<2> setting{.domain = {{8, n}, {true, true}}, .relaxation_rate = 1 / tau, .inertia = inertia};
  Fluid<double> fluid(setting, make_collision(op.id, op.parameters, tau, inertia));
  fluid.set_state([&](int, int y) {
    return Fluid<double>::State{0, {drift + speed * std::sin(k * y), crossing}, {0, speed * k * std::cos(k * y), 0, 0}};
  });
  const auto amplitude = [&] {
    std::complex<double> sum = 0;
    int y = 0;
    for (const Moments<2>& m : column(fluid, 3)) sum += m.velocity[0] * std::polar(1.0, -k * y++);
    return std::abs(sum);
  };
  // What the start disturbs is gone after some relaxation times.
  advance(fluid, 40);
  const double before = amplitude();
  const long steps = std::lround(0.5 / (nu * k * k));
  advance(fluid, steps);
  return std::log(before / amplitude()) / (nu * k * k * static_cast<double>(steps)) - 1;
}

/// Slip of steady Poiseuille flow over n rows in units of the largest velocity: its mean difference from the parabola,
/// and how far the difference is from being the same in all rows.
struct Slip {
  double mean, unevenness;
};
Slip poiseuille_slip(const Operator& op, double tau, bool inertia, int n, double maximum = 0.01) {
  const double nu = (tau - 0.5) / 3, force = 8 * nu * maximum / n / n;
  const auto parabola = [&](double y) { return 4 * (y + 0.5) / n * (1 - (y + 0.5) / n); };
  FluidSetting<2> setting{
      .domain = {{8, n}, {true, false}}, .relaxation_rate = 1 / tau, .inertia = inertia, .body_force = {force}};
  Fluid<double> fluid(setting, make_collision(op.id, op.parameters, tau, inertia));
  fluid.set_profile([&](double y) { return maximum * parabola(y); },
                    [&](double y) { return maximum * 4 / n * (1 - 2 * (y + 0.5) / n); });
  advance(fluid, std::lround(4 * n * n / nu));
  double sum = 0, least = 1, most = -1;
  int y = 0;
  for (const Moments<2>& m : column(fluid, 0)) {
    const double difference = m.velocity[0] / maximum - parabola(y++);
    sum += difference;
    least = std::min(least, difference);
    most = std::max(most, difference);
  }
  return {sum / n, most - least};
}

}  // namespace

TEST_CASE("every operator's viscosity is (tau - 1/2)/3 with an error of second order", "[collision]") {
  const double tau = GENERATE(0.8, 1.4);
  const bool inertia = GENERATE(false, true);
  for (const Operator& op : operators_of_other_magic()) {
    double errors[3];
    int i = 0;
    for (int n : {32, 64, 128}) errors[i++] = viscosity_error(op, tau, inertia, n);
    std::cout << "viscosity, " << op.id << (inertia ? ", inertia" : ", Stokes") << ", tau " << tau << ": errors "
              << errors[0] << " " << errors[1] << " " << errors[2] << ", orders " << std::log2(errors[0] / errors[1])
              << " " << std::log2(errors[1] / errors[2]) << "\n";
    CAPTURE(op.id, inertia, tau);
    CHECK(std::log2(errors[0] / errors[1]) == Approx(2).margin(0.1));
    CHECK(std::log2(errors[1] / errors[2]) == Approx(2).margin(0.1));
    CHECK(std::abs(errors[2]) < 0.001);
  }
}

TEST_CASE("a flow along the wave changes no viscosity, and one across changes it by -3 V^2 but for central moments",
          "[collision]") {
  // The third moment xyy of an equilibrium of second order lacks u V^2, whose gradient is a stress -3 V^2 mu du/dy.
  constexpr double tau = 0.8, v = 0.1;
  constexpr int n = 64;
  for (const Operator& op : shipped_operators()) {
    const double rest = viscosity_error(op, tau, true, n);
    const double along = viscosity_error(op, tau, true, n, v, 0) - rest;
    const double across = viscosity_error(op, tau, true, n, 0, v) - rest;
    std::cout << "viscosity in a stream of 0.1, " << op.id << ": along the wave " << along << ", across " << across
              << "\n";
    CAPTURE(op.id);
    CHECK(std::abs(along) < 3 * v * v / 100);  // not a hundredth of the effect
    // Within a tenth of the effect: the wave moves over the lattice, which costs (k V)^2 besides.
    CHECK(across == Approx(op.id == "central-moment" ? 0 : -3 * v * v).margin(0.003));
  }
}

TEST_CASE(
    "Poiseuille flow slips by (16/3 magic - 1)/N^2 in every operator, so mrt and central-moment do not by default",
    "[collision]") {
  const bool inertia = GENERATE(false, true);
  auto operators = shipped_operators();
  operators.push_back({"central-moment", {1, 1, 1, 0}, of_rate_one, "central-moment, third_order_rate 1"});
  for (const Operator& op : operators) {
    for (const double tau : {0.6, 1.0, 2.0}) {
      for (const int n : {9, 18}) {
        const Slip slip = poiseuille_slip(op, tau, inertia, n);
        const double expected = (16.0 / 3 * op.magic(tau) - 1) / n / n;
        std::cout << "Poiseuille, " << op.name << (inertia ? ", inertia" : ", Stokes") << ", tau " << tau << ", " << n
                  << " rows: slip times N^2 " << slip.mean * n * n << ", formula " << expected * n * n
                  << ", unevenness " << slip.unevenness << "\n";
        CAPTURE(op.name, inertia, tau, n);
        // Central moments with inertia: see the next test.
        const double frame = inertia && op.id == "central-moment" ? 5 * 0.01 * 0.01 / n / n : 0;
        CHECK(slip.mean == Approx(expected).margin(1e-10 + frame));
        CHECK(slip.unevenness < 1e-10 + 2 * frame);
      }
    }
  }
}

TEST_CASE("the frame of central moments moves walls by the square of the speed only", "[collision]") {
  const Operator op = shipped_operators().back();
  const double slow = poiseuille_slip(op, 2, true, 9, 0.005).mean, fast = poiseuille_slip(op, 2, true, 9, 0.01).mean;
  std::cout << "Poiseuille, central-moment, inertia: slip times N^2 over the speed's square " << fast * 81 / 1e-4
            << ", grows as the speed to the power " << std::log2(fast / slow) << "\n";
  CHECK(std::log2(fast / slow) == Approx(2).margin(0.05));
}

TEST_CASE("Couette flow of two layers, viscosity ratio 5, is the exact broken line in every operator", "[collision]") {
  const bool inertia = GENERATE(false, true);
  constexpr int n = 16, layer = 6;  // rows of the thicker fluid below; the layers meet half a spacing above row 5
  const double tau = 0.7, nu = (tau - 0.5) / 3, thick = 0.5 + 5 * (tau - 0.5), speed = 0.01;
  // Equal stress: the shear rates are as 1 : 5, and add up to the speed of the upper wall.
  const double slow = speed / (layer + 5 * (n - layer));
  for (const Operator& op : shipped_operators()) {
    FluidSetting<2> setting{.domain = {{16, n}, {true, false}},
                            .relaxation_rate = 1 / tau,
                            .inertia = inertia,
                            .walls = {0, speed},
                            .membranes = true,
                            .viscosity_contrast = true};
    Fluid<double> fluid(setting, make_collision(op.id, op.parameters, tau, inertia));
    for (int y = 0; y < n; ++y) {
      fluid.mask().mark(y, 0, 16);
      for (int x = 0; x < 16; ++x) fluid.relaxation_rate().row(y)[x] = 1 / (y < layer ? thick : tau);
    }
    fluid.set_profile([](double) { return 0.0; }, [](double) { return 0.0; });
    for (long i = 0; i < std::lround(4 * n * n / nu); ++i) {
      fluid.clear_force(fluid.rows());
      fluid.step(fluid.rows());
      fluid.end_step();
    }
    double error = 0;
    int y = 0;
    fluid.clear_force(fluid.rows());
    for (const Moments<2>& m : column(fluid, 5)) {
      const double height = y++ + 0.5;
      const double exact = height < layer ? slow * height : slow * layer + 5 * slow * (height - layer);
      error = std::max(error, std::abs(m.velocity[0] - exact) / speed);
    }
    std::cout << "two layers, " << op.id << (inertia ? ", inertia" : ", Stokes") << ": largest error " << error << "\n";
    CAPTURE(op.id, inertia);
    // Central moments with inertia: the frame's square of the speed again.
    CHECK(error < (inertia && op.id == "central-moment" ? 0.01 * speed * speed : 1e-10));
  }
}
