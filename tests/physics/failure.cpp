// Runs that really fail: what they report against the linear stability of a flat membrane with explicit coupling.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <iostream>
#include <numbers>
#include <sstream>

#include "scene_run.hpp"
#include "solver_fixture.hpp"

using namespace rouleau::test;
using namespace rouleau::units;

namespace {

const std::string stiff_scene = std::string(ROULEAU_PHYSICS_SCENES) + "/stiff.json";
using std::numbers::pi;
using Complex = std::complex<double>;

double four_point_kernel(double r) {
  const double a = std::abs(r);
  if (a >= 2) return 0;
  return a < 1 ? (3 - 2 * a + std::sqrt(1 + 4 * a - 4 * a * a)) / 8
               : (5 - 2 * a - std::sqrt(std::max(0.0, -7 + 12 * a - 4 * a * a))) / 8;
}

double kernel_transform(double k) {
  constexpr int parts = 400;
  double sum = 0;
  for (int i = 0; i < parts; ++i) {
    const double r = -2 + 4 * (i + 0.5) / parts;
    sum += four_point_kernel(r) * std::cos(k * r);
  }
  return 4 * sum / parts;
}

/// A flat membrane whose nodes move by x(s) = z^n e^{iqs}, along or across it, in a fluid that obeys the linear
/// equations: forces -K x at the beginning of each step, spread and interpolated with the 4-point kernel. Every Fourier
/// mode of the fluid that a force sets going moves on and decays by its own factor in a step, shear by e^{-nu k^2},
/// sound by that and a phase; half a step's force counts at once. So z - 1 = -K G(z) with G the sum over modes of their
/// factors.
class FlatMembrane {
 public:
  explicit FlatMembrane(double viscosity) : viscosity_(viscosity) {
    for (int i = 0; i < modes; ++i) {
      wave_[i] = -2 * pi + step * (i + 0.5);
      transform_[i] = kernel_transform(wave_[i]);
    }
  }

  /// Largest |z| over the roots, at least 1.
  double growth(double q, double stiffness, bool tangential) const {
    const double spread = std::pow(kernel_transform(q), 2);
    const auto equation = [&](Complex z) { return z - 1.0 + stiffness * spread * response(q, z, tangential); };
    double most = 1;
    for (Complex z : {Complex(-1.2, 0.01), Complex(-2, 0), Complex(-5, 0), Complex(-30, 0), Complex(0.9, 0.6),
                      Complex(0.5, 1), Complex(-0.3, 1.1), Complex(-0.8, 0.8), Complex(0.2, 1.3)}) {
      for (int iteration = 0; iteration < 60 && std::abs(z) > 0.9; ++iteration) {
        const Complex value = equation(z), slope = (equation(z + 1e-6) - value) / 1e-6;
        Complex change = value / slope;
        if (std::abs(change) > 0.5 * std::abs(z)) change *= 0.5 * std::abs(z) / std::abs(change);
        z -= change;
        if (std::abs(change) > 1e-9) continue;
        most = std::max(most, std::abs(z));
        break;
      }
    }
    return most;
  }

  /// Wavelength, in spacings, that grows fastest; 0 if none grows.
  double fastest(double modulus, bool stretching, double segment) const {
    double most = 1.001, wavelength = 0;
    for (double length = 2; length < 16; length *= 1.05) {
      const double q = 2 * pi / length, difference = 2 * std::sin(q * segment / 2) / segment;
      const double stiffness = stretching ? 3 * modulus * std::pow(difference, 2) : modulus * std::pow(difference, 4);
      const double factor = growth(q, stiffness, stretching);
      if (factor > most) most = factor, wavelength = length;
    }
    return wavelength;
  }

 private:
  static constexpr int modes = 400;
  static constexpr double step = 4 * pi / modes;

  [[nodiscard]] Complex response(double q, Complex z, bool tangential) const {
    Complex sum = 0;
    for (int i = 0; i < modes; ++i) {
      const double square = q * q + wave_[i] * wave_[i];
      const double shear = (tangential ? wave_[i] * wave_[i] : q * q) / square;
      const double decay = std::exp(-viscosity_ * square), phase = std::sqrt(square / 3);
      const Complex sound =
          0.5 / (1.0 - decay * std::polar(1.0, phase) / z) + 0.5 / (1.0 - decay * std::polar(1.0, -phase) / z);
      sum += transform_[i] * transform_[i] * (shear / (1.0 - decay / z) + (1 - shear) * sound - 0.5);
    }
    return sum * step / (2 * pi);
  }

  double viscosity_;
  double wave_[modes], transform_[modes];
};

/// The run of a cell at rest with one modulus so large, in lattice units.
nlohmann::json failure_of(double modulus, bool stretching, int segments, const std::string& kernel = "peskin4") {
  const LatticeUnits units = SolverBench(stiff_scene).plan.stages[0].units;
  std::ostringstream value;
  value.precision(15);
  value << (stretching ? units.to_si(modulus, dimension::tension)
                       : units.to_si(modulus, Dimension{{1, 2, -2, 0, 0, 0}}));
  const std::string pointer = stretching ? "0/parameters/shear_modulus=" : "1/parameters/modulus=";
  const SceneRun run =
      run_scene(stiff_scene, {"/cell_types/rbc/membrane/" + pointer + value.str(), "/numerics/kernel=" + kernel,
                              "/cell_types/rbc/segments=" + std::to_string(segments)});
  REQUIRE(run.summary["status"] == "diverged");
  return run.summary["failure"];
}

}  // namespace

TEST_CASE("a membrane too stiff for the time step fails in the wave that grows fastest", "[failure]") {
  struct Case {
    bool stretching;
    double modulus;
  };
  const auto [stretching, modulus] =
      GENERATE(Case{true, 5}, Case{true, 50}, Case{false, 9}, Case{false, 20}, Case{false, 100});
  const int segments = GENERATE(100, 200);
  const nlohmann::json failure = failure_of(modulus, stretching, segments);
  const double segment = 4.9285 * 20 / segments, expected = FlatMembrane(1.0 / 6).fastest(modulus, stretching, segment);
  const double found = failure["wavelength_segments"].get<double>(), share = failure["tangential_share"];
  std::cout << (stretching ? "shear" : "bending") << " modulus " << modulus << ", segments of " << segment
            << " spacings: " << failure["mode"] << ", " << found << " segments = " << found * segment
            << " spacings (flat membrane: " << expected << "), tangential share " << share << ", seen at step "
            << failure["mode_step"] << ", stopped at " << failure["step"] << "\n";
  // A cell is no flat membrane, and the analysis takes the continuum's decay of waves of a few spacings.
  CHECK(found * segment == Approx(expected).epsilon(0.35));
  CHECK(failure["mode"] == (found <= 4 ? "node-scale" : stretching ? "tangential" : "normal"));
  CHECK((stretching ? share : 1 - share) > 0.9);
  CHECK(failure["mode_step"] < failure["step"]);
}

TEST_CASE("energy that a suspension at rest gains stops it, though nothing else looks wrong", "[failure]") {
  const std::string two_cells = std::string(ROULEAU_SCENES) + "/../limits/scenes/two-cells.json";
  const std::vector<std::string> at_rest{"/numerics/coupling=semi-implicit", "/stages/1/strain=0.01"};
  const auto run = [&](const std::string& modulus, const std::string& limit) {
    auto overrides = at_rest;
    overrides.push_back("/cell_types/rbc/membrane/0/parameters/shear_modulus=\"" + modulus + "\"");
    overrides.push_back("/checks/energy_growth=" + limit);
    return run_scene(two_cells, overrides);
  };
  // A thousand times a red cell's modulus: the semi-implicit step bears it as far as any other check can see.
  const SceneRun stopped = run("6e-3 N/m", "0.01"), on = run("6e-3 N/m", "1000"), right = run("6e-6 N/m", "0.01");
  REQUIRE(stopped.summary["status"] == "diverged");
  CHECK(stopped.summary["failure"]["reason"] == "energy_growth");
  CHECK(stopped.summary["failure"]["value"] > 0.01);
  CHECK(on.summary["status"] == "completed");
  CHECK(right.summary["status"] == "completed");
  CHECK(right.summary["energy"]["largest_growth_at_rest_relative"] == 0);
  // What was gained has not been written.
  CHECK(stopped.series_column("step").back() < stopped.summary["failure"]["step"]);
  const std::vector<double> total = stopped.series_column("total_energy_J_per_m");
  const double least = *std::min_element(total.begin(), total.end());
  const nlohmann::json gain = stopped.summary["energy"];
  const double there_is =
      gain["largest_growth_at_rest_J_per_m"].get<double>() / gain["largest_growth_at_rest_relative"].get<double>();
  CHECK(total.back() - least < 0.01 * there_is);
}

TEST_CASE("a segment that gives way too far stops a run", "[failure]") {
  const std::string two_cells = std::string(ROULEAU_SCENES) + "/../limits/scenes/two-cells.json";
  const SceneRun run = run_scene(two_cells, {"/checks/stretch=1.01"});
  REQUIRE(run.summary["status"] == "diverged");
  const nlohmann::json failure = run.summary["failure"];
  CHECK(failure["reason"] == "uneven_nodes");
  CHECK((failure["value"] > 1.01 || failure["value"] < 1 / 1.01));
  CHECK(failure["cell"] >= 0);
}

TEST_CASE("a kernel that does not see neighbouring nodes apart lets them zigzag", "[failure]") {
  const auto kernel = GENERATE("roma3", "linear2");
  const nlohmann::json failure = failure_of(3, true, 100, kernel);
  std::cout << kernel << ": " << failure["mode"] << ", " << failure["wavelength_segments"] << " segments, share "
            << failure["tangential_share"] << "\n";
  CHECK(failure["mode"] == "node-scale");
  CHECK(failure["wavelength_segments"] < 3);
  CHECK(failure["tangential_share"] > 0.9);
  CHECK(failure["remedy"].get<std::string>().find("peskin4") != std::string::npos);
}
