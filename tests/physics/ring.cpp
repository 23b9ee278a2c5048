// A pre-stretched ring at rest: Laplace pressure, and the decay of an elliptic disturbance in the channel.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>

#include "core/membrane/geometry.hpp"
#include "scene_run.hpp"
#include "solver_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::test;
using namespace rouleau::units;

namespace {

/// Mean density deviation over nodes within (inside) or beyond (outside) given distances from the cell's centre.
double mean_density(SolverBench& bench, double from, double to) {
  const Eigen::Vector2d c = centroid(bench.membranes, bench.membranes.cells[0]);
  auto& fluid = bench.solver->fluid();
  fluid.settle();
  double sum = 0;
  int count = 0;
  std::vector<Moments<2>> row;
  for (int y = 0; y < fluid.setting().domain.size[1]; ++y) {
    fluid.moments(y, row);
    for (int x = 0; x < fluid.setting().domain.size[0]; ++x) {
      const double r = std::hypot(x - c.x(), y - c.y());
      if (r >= from && r < to) sum += row[static_cast<std::size_t>(x)].density, ++count;
    }
  }
  return sum / count;
}

/// Relative excess of the pressure difference across the ring at rest over tension by radius. `tension`: at a stretch,
/// over 1e-6 N/m.
double pressure_excess(const std::vector<std::string>& overrides, const std::function<double(double)>& tension) {
  SolverBench bench(scenes + "/ring.json", overrides);
  bench.start();
  bench.step(16000);  // sound that the sudden start made rings for about 10 000 steps
  bench.forces();
  const CellRange& cell = bench.membranes.cells[0];
  const double radius = std::sqrt(enclosed_area(bench.membranes, cell) / std::numbers::pi);
  const double e = perimeter(bench.membranes, cell) / cell.rest_perimeter;
  const double modulus = bench.plan.stages[0].units.to_lattice(1e-6, dimension::tension);
  const double expected = tension(e);
  const double found = (mean_density(bench, 0, 12) - mean_density(bench, 30, 60)) / 3 * radius / modulus;
  std::cout << "Laplace, stretch " << e << ": dp R / 1e-6 N/m " << found << " (exact " << expected << ", "
            << 100 * (found / expected - 1) << " %)\n";
  return found / expected - 1;
}

}  // namespace

TEST_CASE("the pressure in a stretched ring exceeds that outside by tension over radius", "[ring]") {
  const double prestretch = GENERATE(1.05, 1.1, 1.2);
  const double excess = pressure_excess({"/cell_types/ring/shape/circle/prestretch=" + std::to_string(prestretch)},
                                        [](double e) { return std::pow(e, 1.5) - std::pow(e, -1.5); });
  CHECK(std::abs(excess) < 1e-3);
}

TEST_CASE("every membrane law stretches a ring to its own tension over radius", "[ring]") {
  // Tension over 1e-6 N/m at the stretch e: the two-dimensional materials in one direction, with C = 2.
  const auto free_width = [](double e) {
    double low = 0.1, high = 10;  // no tension across: l^2 - 1 + C e^2 ((e l)^2 - 1) = 0
    for (int i = 0; i < 100; ++i) {
      const double l = (low + high) / 2;
      (l * l - 1 + 2 * e * e * (e * e * l * l - 1) < 0 ? low : high) = l;
    }
    return low;
  };
  const auto skalak = [](double e, double l) { return e / l * (e * e - 1 + 2 * l * l * (e * e * l * l - 1)); };
  const auto [law, tension] = GENERATE_REF(table<std::string, std::function<double(double)>>({
      {R"("neo-hookean", "parameters": {"shear_modulus": 1e-6, "transverse": "clamped"})",
       [](double e) { return e - std::pow(e, -3); }},
      {R"("skalak", "parameters": {"shear_modulus": 1e-6, "area_dilation": 2, "transverse": "clamped"})",
       [=](double e) { return skalak(e, 1); }},
      {R"("skalak", "parameters": {"shear_modulus": 1e-6, "area_dilation": 2, "transverse": "free"})",
       [=](double e) { return skalak(e, free_width(e)); }},
      {R"("hooke", "parameters": {"stretching_modulus": 1e-6})", [](double e) { return e - 1; }},
      {R"("inextensible", "parameters": {"stretching_modulus": 1e-6})",
       [](double e) { return (e * e - 1 / (e * e)) / 4; }},
      {R"("perimeter", "parameters": {"modulus": 1e-6})", [](double e) { return e - 1; }},
      {R"("perimeter", "parameters": {"modulus": 1e-6, "ratio": 1.04})", [](double e) { return e / 1.04 - 1; }},
  }));
  std::cout << law << "\n  ";
  const double excess = pressure_excess({"/cell_types/ring/membrane/0={\"model\": " + law + "}"}, tension);
  CHECK(std::abs(excess) < 1e-3);
}

TEST_CASE("an area law presses on the fluid inside with its modulus times the change of area", "[ring]") {
  // A tenth more area is wanted than there is: the pressure inside falls by K 0.1/1.1; K a is 0.8 x 1e-6 N/m here.
  const double excess = pressure_excess(
      {R"(/cell_types/ring/membrane/-={"model": "area", "parameters": {"modulus": "0.2 Pa", "ratio": 1.1}})"},
      [](double e) { return std::pow(e, 1.5) - std::pow(e, -1.5) - 0.8 * 0.1 / 1.1; });
  CHECK(std::abs(excess) < 1e-3);
}

TEST_CASE("an elliptic disturbance of a pre-stretched ring decays as the boundary-integral solution",
          "[ring][weekly]") {
  const nlohmann::json tables = read_reference("analytic.json")["relaxation_tables"];
  // A Stokes flow is asked for: tension waves must be slow against diffusion over the cell, Es a / (nu^2) small.
  const double amplitude = 0.1;
  nlohmann::json reference;
  for (const auto& t : tables) {
    if (t["parameters"]["walls"] != "none" && t["parameters"]["A"] == amplitude) reference = t;
  }
  REQUIRE(reference.is_object());
  // At 20 spacings a kernel holds back the second mode's normal motion by (2/a)^2 x 1.05 spacings^2, 1 %; what the
  // plain scheme slips happens to hide part of that.
  const auto [corrected, tolerance] = GENERATE(table<const char*, double>({{"true", 0.02}, {"false", 0.01}}));
  SolverBench bench(scenes + "/ring.json",
                    {"/numerics/density_factor=75", std::string("/numerics/slip_correction=") + corrected,
                     std::string("/numerics/area_correction=") + corrected});
  Membranes& m = bench.membranes;
  const Eigen::Vector2d c = centroid(m, m.cells[0]);
  const double radius = 4e-6 / bench.plan.stages[0].units.length;
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    const double angle = std::atan2(m.position[1][i] - c.y(), m.position[0][i] - c.x());
    m.position[0][i] = c.x() + radius * (1 + amplitude * std::cos(2 * angle)) * std::cos(angle);
    m.position[1][i] = c.y() + radius * (1 + amplitude * std::cos(2 * angle)) * std::sin(angle);
  }
  m.cells[0].rest_area = enclosed_area(m, m.cells[0]);  // what the area correction holds on to
  bench.start();
  const LatticeUnits& units = bench.plan.stages[0].units;
  const double steps_per_unit = 1.2e-3 * 4e-6 / 1e-6 / units.time;  // mu a / Es
  double worst = 0;
  long step = 0;
  for (const auto& row : reference["values"]) {
    const double t = row[0], d = row[2];
    if (t > 14) break;
    const long target = std::lround(t * steps_per_unit);
    bench.step(target - step);
    step = target;
    const double found = inertia_ellipse(m, m.cells[0]).deformation;
    if (std::fmod(t, 2.0) == 0)
      std::cout << "ring, t " << t << ": D " << found << " (" << 100 * (found / d - 1) << " %)\n";
    worst = std::max(worst, std::abs(found / d - 1));
  }
  std::cout << "ring in the channel, A 0.1, to t = 14, slip correction " << corrected << ": largest error of D "
            << 100 * worst << " %\n";
  CHECK(worst < tolerance);
}
