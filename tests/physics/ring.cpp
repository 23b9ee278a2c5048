// A pre-stretched ring at rest: Laplace pressure, and the decay of an elliptic disturbance in the channel.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "cell/geometry.hpp"
#include "scene_run.hpp"
#include "solver_fixture.hpp"

using namespace rouleau::host;

namespace {

const std::string ring = std::string(ROULEAU_PHYSICS_SCENES) + "/ring.json";

/// Mean density deviation over nodes within (inside) or beyond (outside) given distances from the cell's centre.
double mean_density(SolverBench& bench, double from, double to) {
  const Eigen::Vector2d c = centroid(bench.membranes, bench.membranes.cells[0]);
  auto& fluid = bench.solver->fluid();
  fluid.settle();
  double sum = 0;
  int count = 0;
  std::vector<Moments> row;
  for (int y = 0; y < fluid.setting().ny; ++y) {
    fluid.moments(y, row);
    for (int x = 0; x < fluid.setting().nx; ++x) {
      const double r = std::hypot(x - c.x(), y - c.y());
      if (r >= from && r < to) sum += row[static_cast<std::size_t>(x)].density, ++count;
    }
  }
  return sum / count;
}

}  // namespace

TEST_CASE("the pressure in a stretched ring exceeds that outside by tension over radius", "[ring]") {
  const double prestretch = GENERATE(1.05, 1.1, 1.2);
  SolverBench bench(ring, {"/cell_types/ring/shape/circle/prestretch=" + std::to_string(prestretch)});
  bench.start();
  bench.step(16000);  // sound that the sudden start made rings for about 10 000 steps
  bench.forces();
  const CellRange& cell = bench.membranes.cells[0];
  const double radius = std::sqrt(enclosed_area(bench.membranes, cell) / std::numbers::pi);
  const double e = perimeter(bench.membranes, cell) / cell.rest_perimeter;
  const double modulus = bench.plan.stages[0].units.to_lattice(1e-6, dimension::tension);
  const double expected = modulus * (std::pow(e, 1.5) - std::pow(e, -1.5)) / radius;
  const double found = (mean_density(bench, 0, 12) - mean_density(bench, 30, 60)) / 3;
  std::cout << "Laplace, stretch " << e << ": dp R / Es " << found * radius / modulus << " (exact "
            << expected * radius / modulus << ", " << 100 * (found / expected - 1) << " %)\n";
  CHECK(found == Approx(expected).epsilon(1e-3));
}

TEST_CASE("an elliptic disturbance of a pre-stretched ring decays as the boundary-integral solution", "[ring]") {
  const nlohmann::json tables = read_reference("analytic.json")["relaxation_tables"];
  // A Stokes flow is asked for: tension waves must be slow against diffusion over the cell, Es a / (nu^2) small.
  const double amplitude = 0.1;
  nlohmann::json table;
  for (const auto& t : tables) {
    if (t["parameters"]["walls"] != "none" && t["parameters"]["A"] == amplitude) table = t;
  }
  REQUIRE(table.is_object());
  SolverBench bench(ring);
  Membranes& m = bench.membranes;
  const Eigen::Vector2d c = centroid(m, m.cells[0]);
  const double radius = 4e-6 / bench.plan.stages[0].units.length;
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    const double angle = std::atan2(m.y[i] - c.y(), m.x[i] - c.x());
    m.x[i] = c.x() + radius * (1 + amplitude * std::cos(2 * angle)) * std::cos(angle);
    m.y[i] = c.y() + radius * (1 + amplitude * std::cos(2 * angle)) * std::sin(angle);
  }
  bench.start();
  const LatticeUnits& units = bench.plan.stages[0].units;
  const double steps_per_unit = 1.2e-3 * 4e-6 / 1e-6 / units.time;  // mu a / Es
  double worst = 0;
  long step = 0;
  for (const auto& row : table["values"]) {
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
  std::cout << "ring in the channel, A 0.1, to t = 14: largest error of D " << 100 * worst << " %\n";
  CHECK(worst < 0.03);
}
