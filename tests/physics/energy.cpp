// The energy ledger against exact energies and powers, and against itself: what is lost must have been there.
#include "observe/energy.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/membrane/geometry.hpp"
#include "plan/placed_cells.hpp"
#include "scene_run.hpp"
#include "solver_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::observe;
using namespace rouleau::plan;
using namespace rouleau::plugin;
using namespace rouleau::scene;
using namespace rouleau::test;

namespace {

/// With the forces of the next step, which laws that remember must not be asked for twice.
EnergySnapshot ledger_now(SolverBench& bench) {
  bench.solver->fluid().settle();
  return observe_energy(*bench.solver, bench.plan.stages[0].units);
}
EnergySnapshot ledger(SolverBench& bench) {
  bench.forces();
  return ledger_now(bench);
}

/// An ellipse of the ring's scene, stretched, with a = `nodes` spacings, let go.
void stretch_to_ellipse(SolverBench& bench, double amplitude) {
  Membranes& m = bench.membranes;
  const Eigen::Vector2d c = centroid(m, m.cells[0]);
  const double radius = 4e-6 / bench.plan.stages[0].units.length;
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    const double angle = std::atan2(m.position[1][i] - c.y(), m.position[0][i] - c.x());
    const double r = radius * (1 + amplitude * std::cos(2 * angle));
    m.position[0][i] = c.x() + r * std::cos(angle);
    m.position[1][i] = c.y() + r * std::sin(angle);
  }
}

struct Closure {
  double dropped, lost;  ///< J/m: by the total energy, and by the dissipation's integral over time
  [[nodiscard]] double error() const { return lost / dropped - 1; }
};

/// From `begin` to `end` in mu a/Es, the ledger taken every `every` steps and integrated by the trapezoidal rule.
Closure close_balance(SolverBench& bench, double begin, double end, long every) {
  const double unit = 1.2e-3 * 4e-6 / 1e-6 / bench.plan.stages[0].units.time;
  bench.step(std::lround(begin * unit));
  const long steps = std::lround((end - begin) * unit / static_cast<double>(every)) * every;
  EnergySnapshot before = ledger(bench);
  const double first = before.total;
  Closure closure{};
  for (long step = 0; step < steps; step += every) {
    for (long i = 0; i < every; ++i) {
      bench.solver->advance();
      bench.forces();
    }
    const EnergySnapshot now = ledger_now(bench);
    const double lost =
        now.viscous_dissipation + now.membrane_dissipation + before.viscous_dissipation + before.membrane_dissipation;
    closure.lost += lost / 2 * static_cast<double>(every) * bench.plan.stages[0].units.time;
    before = now;
  }
  bench.solver->advance();
  closure.dropped = first - before.total;
  return closure;
}

/// The ring of viscous-ring.json as an ellipse, `a` spacings large, on a lattice of 6.4 a x 3.2 a.
std::unique_ptr<SolverBench> ellipse(int a, const std::vector<std::string>& overrides) {
  std::vector<std::string> all{"/domain/nodes=[" + std::to_string(32 * a / 5) + "," + std::to_string(16 * a / 5) + "]",
                               "/cell_types/ring/segments=" + std::to_string(63 * a / 10)};
  all.insert(all.end(), overrides.begin(), overrides.end());
  auto bench = std::make_unique<SolverBench>(scenes + "/viscous-ring.json", all);
  stretch_to_ellipse(*bench, 0.2);
  bench->start();
  return bench;
}

std::string setting(const char* pointer, double value) {
  std::ostringstream text;
  text << pointer << "=" << value;
  return text.str();
}

/// Fluid alone in a channel of 25.6 um x 12.8 um, `rows` spacings high.
std::unique_ptr<SolverBench> channel(int rows, const std::string& stage, bool inertia) {
  auto bench = std::make_unique<SolverBench>(
      scenes + "/viscous-ring.json",
      std::vector<std::string>{"/cells=[]",
                               "/domain/nodes=[" + std::to_string(2 * rows) + "," + std::to_string(rows) + "]",
                               std::string("/fluid/inertia=") + (inertia ? "true" : "false"), "/stages/0=" + stage});
  bench->start();
  return bench;
}
constexpr double mu = 1.2e-3, width = 25.6e-6, height = 12.8e-6;

}  // namespace

TEST_CASE("in Couette flow the walls put in what viscosity takes, mu gamma^2 for each area", "[energy]") {
  const bool inertia = GENERATE(false, true);
  const auto bench = channel(32, R"({"name": "shear", "shear_rate": "20 1/s", "strain": 100})", inertia);
  bench->step(20000);  // 20 times the time in which momentum crosses half the channel
  const EnergySnapshot e = ledger(*bench);
  const double exact = mu * 20 * 20 * width * height;
  std::cout << "Couette, inertia " << inertia << ": dissipation " << e.viscous_dissipation / exact - 1
            << ", wall power " << e.wall_power / exact - 1 << " from exact\n";
  CHECK(e.viscous_dissipation == Approx(exact).epsilon(1e-9));
  CHECK(e.wall_power == Approx(exact).epsilon(1e-9));
  // The simulated fluid is 300 times denser. Sum over rows instead of the integral: (1 - 1/N^2).
  CHECK(e.kinetic == Approx(1000 * 300 * 400 * std::pow(height, 3) * width / 24 * (1 - 1.0 / (32 * 32))).epsilon(1e-9));
  CHECK(std::isnan(e.body_force_power));
  CHECK(std::isnan(e.elastic));
  CHECK(e.total == e.kinetic);
}

TEST_CASE("in Poiseuille flow the driving force puts in what viscosity takes, G^2 H^3/(12 mu) for each length",
          "[energy]") {
  const bool inertia = GENERATE(false, true);
  const int rows = GENERATE(16, 32);
  const auto bench = channel(rows, R"({"name": "flow", "pressure_gradient": "1 kPa/m", "duration": "10 s"})", inertia);
  bench->step(20L * rows * rows);
  const EnergySnapshot e = ledger(*bench);
  const double exact = 1000.0 * 1000 * std::pow(height, 3) / (12 * mu) * width;
  std::cout << "Poiseuille, " << rows << " rows, inertia " << inertia << ": dissipation over power "
            << e.viscous_dissipation / e.body_force_power - 1 << ", power " << e.body_force_power / exact - 1
            << " from exact (1/(2 N^2) = " << 0.5 / (rows * rows) << ")\n";
  CHECK(e.viscous_dissipation == Approx(e.body_force_power).epsilon(1e-9));
  // The parabola is exact at the nodes (magic 3/16); its sum over rows is larger than the integral by 1/(2 N^2).
  CHECK(e.body_force_power == Approx(exact * (1 + 0.5 / (rows * rows))).epsilon(1e-6));
  CHECK(e.wall_power == 0);
}

TEST_CASE("a stretched and bent ring holds the energy of its laws' formulae", "[energy]") {
  const double prestretch = GENERATE(1.05, 1.2, 1.5);
  SolverBench bench(scenes + "/viscous-ring.json", {setting("/cell_types/ring/shape/circle/prestretch", prestretch),
                                                    R"(/cell_types/ring/membrane/1={"model": "bending", "parameters":
                        {"modulus": "2e-19 J", "rest_curvature": "zero"}})"});
  bench.start();
  const EnergySnapshot e = ledger(bench);
  // A polygon of 126 sides: rest length of all, and turning angles of 2 pi in all.
  const double rest = 2 * 126 * 4e-6 * std::sin(std::numbers::pi / 126) / prestretch;
  const double elastic = 1e-6 * (0.4 * std::pow(prestretch, 2.5) + 2 / std::sqrt(prestretch) - 2.4) * rest;
  const double bending = 2e-19 / 2 * std::pow(2 * std::numbers::pi, 2) / rest;
  std::cout << "ring stretched by " << prestretch << ": elastic " << e.elastic / elastic - 1 << ", bending "
            << e.bending / bending - 1 << " from exact\n";
  CHECK(e.elastic == Approx(elastic).epsilon(1e-9));
  CHECK(e.bending == Approx(bending).epsilon(1e-9));
  CHECK(e.total - e.kinetic == Approx(elastic + bending).epsilon(1e-9));
  CHECK(e.kinetic < 1e-3 * e.total);  // of half the forces' first step
  CHECK(e.membrane_dissipation == 0);
}

TEST_CASE("what a released ring loses is what viscosity takes, to first order in the time step", "[energy]") {
  // The forces of a step are those at its beginning. The sudden start has the largest error; later it is far smaller.
  const double tau = GENERATE(0.6, 1.0, 2.0);
  std::vector<double> start, later;
  for (const double factor : {300.0, 150.0, 75.0, 37.5}) {
    // dt = (tau - 1/2)/3 dx^2 rho f/mu: the same series of time steps for every tau.
    const auto bench =
        ellipse(10, {setting("/numerics/tau", tau), setting("/numerics/density_factor", factor * 0.5 / (tau - 0.5))});
    start.push_back(close_balance(*bench, 0, 0.1, 1).error());
    later.push_back(close_balance(*bench, 0, 0.9, 1).error());
    std::cout << "ring, tau " << tau << ", " << 2880 * 75 / factor
              << " steps for mu a/Es: lost over dropped - 1: " << start.back() << " at the start, " << later.back()
              << " later\n";
  }
  const double order = std::log2(std::abs(start[0] / start[3])) / 3;
  std::cout << "  order " << order << "\n";
  CHECK(order > 0.9);
  CHECK(std::abs(start[3]) < 1e-3);
  CHECK(std::abs(later[3]) < 2e-5);
}

TEST_CASE("the balance closes at every resolution, with a viscosity contrast and with viscous membranes", "[energy]") {
  const auto [a, ratio, viscosity] =
      GENERATE(table<int, double, double>({{10, 1, 0}, {20, 1, 0}, {10, 5, 0}, {10, 1, 1}, {10, 5, 10}}));
  const auto bench =
      ellipse(a, {"/numerics/density_factor=75", setting("/cell_types/ring/interior_viscosity", mu * ratio),
                  setting("/cell_types/ring/membrane/1/parameters/viscosity", viscosity * mu * 4e-6)});
  const Closure closure = close_balance(*bench, 0.1, 0.5, 1);
  const EnergySnapshot e = ledger(*bench);
  std::cout << "ring, a " << a << ", lambda " << ratio << ", mu_m/(mu a) " << viscosity
            << ": lost over dropped - 1: " << closure.error() << "; membrane's share "
            << e.membrane_dissipation / (e.membrane_dissipation + e.viscous_dissipation) << "\n";
  CHECK(std::abs(closure.error()) < 1e-4);
  if (viscosity > 0) CHECK(e.membrane_dissipation > 0.05 * e.viscous_dissipation);
}

TEST_CASE("with corrections of the membranes' motion the balance closes, too", "[energy]") {
  const double ratio = GENERATE(1.0, 5.0);
  const auto bench =
      ellipse(10, {"/numerics/density_factor=75", setting("/cell_types/ring/interior_viscosity", mu * ratio),
                   "/numerics/slip_correction=true", "/numerics/area_correction=true"});
  const Closure closure = close_balance(*bench, 0.1, 0.5, 1);
  std::cout << "ring, corrected, lambda " << ratio << ": lost over dropped - 1: " << closure.error() << "\n";
  CHECK(std::abs(closure.error()) < 1e-2);
}

TEST_CASE("two discs that attract hold the Derjaguin integral of their potential", "[energy]") {
  // Each element of one disc with the distance of the other disc, half from each side.
  const double gap = GENERATE(0.4e-6, 0.8e-6);
  const double depth = 5.2e-8, beta = 3.84e6, zero_force = 0.49e-6, cutoff = 3.52e-6, disc = 4e-6;
  double integral = 0;
  constexpr int parts = 1000000;
  for (int i = 0; i < parts; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / parts;
    const double distance = std::hypot(2 * disc + gap - disc * std::cos(angle), disc * std::sin(angle)) - disc;
    const double s = std::exp(beta * (zero_force - distance));
    if (distance < cutoff) integral += depth * s * (s - 2) * 2 * std::numbers::pi * disc / parts;
  }
  std::vector<double> errors;
  for (const int segments : {63, 126, 252}) {
    const double x = 12.8e-6 - disc - gap / 2;
    std::ostringstream cells;
    cells.precision(17);
    cells << R"(/cells=[{"type": "ring", "at": [)" << x << R"(, "6.4 um"]}, {"type": "ring", "at": [)"
          << x + 2 * disc + gap << R"(, "6.4 um"]}])";
    SolverBench bench(scenes + "/viscous-ring.json", {cells.str(), "/cell_types/ring/shape/circle/prestretch=1",
                                                      "/cell_types/ring/segments=" + std::to_string(segments),
                                                      R"(/interactions=[{"between": ["ring", "ring"], "model": "morse",
                          "parameters": {"depth": 5.2e-8}}])"});
    bench.start();
    const EnergySnapshot e = ledger(bench);
    errors.push_back(e.interaction / integral - 1);
    std::cout << "discs " << gap * 1e6 << " um apart, " << segments << " segments: " << e.interaction << " J/m, "
              << errors.back() << " from the integral\n";
    CHECK(std::abs(e.elastic) < 1e-9 * std::abs(e.interaction));
  }
  CHECK(std::abs(errors[2]) < 2e-3);
  CHECK(std::abs(errors[2]) < std::abs(errors[0]) / 10);  // polygons: second order
}

TEST_CASE("at rest the total energy of cells that attract never grows", "[energy][weekly]") {
  const bool semi_implicit = GENERATE(false, true);
  const SceneRun run = run_scene(
      scenes + "/viscous-ring.json",
      {R"(/cell_types/ring/membrane/1={"model": "bending", "parameters": {"modulus": "3.6e-19 J"}})",
       R"(/cells=[{"type": "ring", "at": ["8.2 um", "6.4 um"]}, {"type": "ring", "at": ["17.4 um", "6.4 um"]}])",
       R"(/interactions=[{"between": ["ring", "ring"], "model": "morse", "parameters": {"depth": 5.2e-8}}])",
       R"(/stages=[{"name": "first", "duration": "0.4 s", "density_factor": 1000},
                   {"name": "second", "duration": "0.2 s", "density_factor": 300}])",
       std::string("/numerics/coupling=") + (semi_implicit ? "semi-implicit" : "explicit"),
       R"(/output={"cells": {"seconds": 0.002}})"});
  const auto total = run.series_column("total_energy_J_per_m"),
             interaction = run.series_column("interaction_energy_J_per_m");
  const auto& energy = run.summary["energy"];
  std::cout << "two rings at rest, " << total.size() << " outputs: total from " << total.front() << " to "
            << total.back() << " J/m, interaction from " << interaction.front() << " to " << interaction.back() << ": "
            << energy.dump() << "\n";
  CHECK(total.back() < total.front());
  CHECK(interaction.back() < 2 * interaction.front());
  CHECK(energy["stages_at_rest"].size() == 2);
  CHECK(energy["unknown"].is_null());
  CHECK(energy["largest_growth_at_rest_relative"].get<double>() < 1e-5);
}

TEST_CASE("single precision tells the same energies and powers to a thousandth", "[energy]") {
  const std::vector<std::string> scene{
      R"(/stages=[{"name": "shear", "shear_rate": "20 1/s", "strain": 0.2, "start": "developed"}])",
      R"(/output={"cells": {"strain": 0.05}})"};
  std::vector<SceneRun> runs;
  for (const char* precision : {"f64", "f32"}) {
    auto overrides = scene;
    overrides.push_back(std::string("/numerics/precision=") + precision);
    runs.push_back(run_scene(scenes + "/viscous-ring.json", overrides));
  }
  for (const char* column : {"total_energy_J_per_m", "viscous_dissipation_W_per_m", "wall_power_W_per_m"}) {
    const auto exact = runs[0].series_column(column), single = runs[1].series_column(column);
    REQUIRE(exact.size() == single.size());
    for (std::size_t i = 1; i < exact.size(); ++i) {
      INFO(column << ", row " << i);
      CHECK(single[i] == Approx(exact[i]).epsilon(1e-3));
    }
  }
}

TEST_CASE("a decaying vortex between periodic sides loses what viscosity takes", "[energy]") {
  // Taylor-Green: u = U sin kx cos ky, v = -U cos kx sin ky; energy falls by exp(-4 nu k^2 t).
  const int n = GENERATE(32, 64);
  for (const double tau : {0.6, 1.0, 2.0}) {
    const double k = 2 * std::numbers::pi / n, speed = 1e-3, nu = (tau - 0.5) / 3;
    FluidSetting<2> setting{.domain = {{n, n}, {true, true}}, .relaxation_rate = 1 / tau};
    Fluid<double> fluid(setting, make_collision("trt", {3.0 / 16}, tau, false));
    fluid.set_state([&](int x, int y) -> Fluid<double>::State {
      const double sx = std::sin(k * x), cx = std::cos(k * x), sy = std::sin(k * y), cy = std::cos(k * y);
      return {0,
              speed * sx * cy,
              -speed * cx * sy,
              {speed * k * cx * cy, -speed * k * sx * sy, speed * k * sx * sy, -speed * k * cx * cy}};
    });
    fluid.settle();
    const auto before = fluid.energetics();
    CHECK(before.kinetic == Approx(speed * speed / 4 * n * n));
    double lost = before.dissipation / 2;
    constexpr int steps = 200;
    for (int i = 0; i < steps; ++i) {
      advance(fluid, 1);
      fluid.settle();
      lost += fluid.energetics().dissipation * (i + 1 < steps ? 1 : 0.5);
    }
    const double dropped = before.kinetic - fluid.energetics().kinetic;
    std::cout << "vortex, " << n << " nodes, tau " << tau
              << ": dissipation over 4 nu k^2 K - 1: " << before.dissipation / (4 * nu * k * k * before.kinetic) - 1
              << ", lost over dropped - 1: " << lost / dropped - 1 << "\n";
    // Second order in the spacing; and first order in the step, in which the velocity falls by 2 nu k^2.
    CHECK(before.dissipation == Approx(4 * nu * k * k * before.kinetic).epsilon(0.7 * k * k));
    CHECK(lost / dropped - 1 > 0);
    CHECK(lost / dropped - 1 < 1.05 * nu * k * k);
  }
}

TEST_CASE("a law that acts and gives no energy leaves the total unknown, and says which it is", "[energy]") {
  const auto [folder, law] =
      GENERATE(table<std::string, std::string>({{"membrane/neo-hookean/neo-hookean", "membrane law neo-hookean"},
                                                {"interaction/morse/morse", "interaction morse"}}));
  const rouleau::test::ScratchFolder copy;
  std::filesystem::copy(ROULEAU_PLUGINS, copy.path() / "plugins", std::filesystem::copy_options::recursive);
  const auto file = copy.path() / "plugins" / (folder + ".json");
  nlohmann::json manifest = nlohmann::json::parse(std::ifstream(file));
  auto& gives = manifest["gives"];
  gives.erase(std::find(gives.begin(), gives.end(), "energy"));
  manifest.erase("checks");
  std::ofstream(file) << manifest;

  const Scene scene =
      read_scene(scenes + "/viscous-ring.json", {R"(/interactions=[{"between": ["ring", "ring"], "model": "morse",
                                     "parameters": {"depth": 5.2e-8}}])"});
  const Catalog catalog({copy.path() / "plugins"});
  const Plan plan = make_plan(scene, catalog);
  Membranes membranes = make_cells<2>(scene, lattice_spacing(scene));
  Solver<double> solver(make_solver_setup(plan, 0), membranes);
  solver.compute_forces();
  solver.fluid().settle();
  const EnergySnapshot e = observe_energy(solver, plan.stages[0].units);
  CHECK(std::isnan(e.total));
  CHECK(e.unknown == law + " gives no energy");
  CHECK(std::isfinite(e.kinetic));
}

TEST_CASE("the balance closes with a membrane that remembers, fast and slow", "[energy]") {
  const double relaxation = GENERATE(0.1, 1.0, 10.0);  // over mu a/Es
  const auto bench = ellipse(10, {"/numerics/density_factor=75",
                                  R"(/cell_types/ring/membrane/1={"model": "standard-linear-solid", "parameters":
              {"modulus": "2e-6 N/m", "relaxation_time": )" +
                                      std::to_string(relaxation * mu * 4e-6 / 1e-6) + "}}"});
  const Closure closure = close_balance(*bench, 0.1, 0.5, 1);
  const EnergySnapshot e = ledger(*bench);
  std::cout << "ring with a Maxwell branch, relaxation time " << relaxation
            << " mu a/Es: lost over dropped - 1: " << closure.error() << "; membrane's share "
            << e.membrane_dissipation / (e.membrane_dissipation + e.viscous_dissipation) << "\n";
  CHECK(std::abs(closure.error()) < 1e-3);
  CHECK(e.membrane_dissipation > 0.01 * e.viscous_dissipation);
}
