// Walls that repel or hold cells: where a cell comes to rest, what its energy becomes, what the walls' stress knows of
// it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/contact/wall_contacts.hpp"
#include "core/contact/wall_gap.hpp"
#include "core/membrane/geometry.hpp"
#include "observe/aggregates.hpp"
#include "observe/energy.hpp"
#include "observe/observer.hpp"
#include "observe/rheology.hpp"
#include "scene_run.hpp"
#include "solver_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::observe;
using namespace rouleau::plan;
using namespace rouleau::scene;
using namespace rouleau::test;

namespace {

constexpr double ring_radius = 4e-6;

std::string held(double depth, const char* zero_force = "0.49 um") {
  std::ostringstream text;
  text.precision(17);
  text << R"(/interactions=[{"between": ["ring", "wall"], "model": "morse", "parameters": {"depth": )" << depth
       << R"(, "zero_force_distance": ")" << zero_force << R"("}}])";
  return text.str();
}
std::string ring_at(double y) {
  std::ostringstream text;
  text.precision(17);
  text << R"(/cells=[{"type": "ring", "at": ["12.8 um", )" << y << "]}]";
  return text.str();
}
/// The ring's scene with `a` spacings in a radius.
std::vector<std::string> lattice(int a) {
  return {"/domain/nodes=[" + std::to_string(32 * a / 5) + "," + std::to_string(16 * a / 5) + "]",
          "/cell_types/ring/segments=" + std::to_string(63 * a / 10)};
}
std::vector<std::string> with(std::vector<std::string> all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

double gap_of(const SolverBench& bench) {  // spacings
  return wall_gap(bench.membranes, bench.membranes.cells[0], bench.solver->setup().domain);
}

/// Where the energy of membrane and wall together is least at the given area, found without any fluid: damped motion of
/// unit masses, every component of which stops where it turns against its force (Bitzek et al., 2006).
void minimise(const SolverSetup& setup, Membranes& m, double area) {
  MembraneForces membrane(m, {.laws = {setup.cell_types[0].laws}, .viscosity = setup.viscosity()});
  WallContacts<2> walls(m, setup.wall_interactions, setup.domain);
  const CellRange& cell = m.cells[0];
  std::vector<double> u(m.position[0].size(), 0.0), v(m.position[0].size(), 0.0);
  double step = 0.05, damping = 0.1;
  int downhill = 0;
  for (int iteration = 0; iteration < 400000; ++iteration) {
    std::fill(m.velocity[0].begin(), m.velocity[0].end(), 0.0),
        std::fill(m.velocity[1].begin(), m.velocity[1].end(), 0.0);
    membrane.run({}, m);
    walls.run({}, m);
    const double pressure = 2 * (area - enclosed_area(m, cell)) / area;
    double power = 0, speed = 0, force = 0;
    std::vector<double> fx = m.force[0], fy = m.force[1];
    for (int i = cell.first; i < cell.end(); ++i) {
      const int after = cell.next(i), before = i == cell.first ? cell.end() - 1 : i - 1;
      fx[i] += pressure * (m.position[1][after] - m.position[1][before]) / 2;  // dA/dX
      fy[i] -= pressure * (m.position[0][after] - m.position[0][before]) / 2;
      power += fx[i] * u[i] + fy[i] * v[i];
      speed += u[i] * u[i] + v[i] * v[i];
      force += fx[i] * fx[i] + fy[i] * fy[i];
    }
    if (force < 1e-26) break;
    if (power > 0) {
      const double turn = damping * std::sqrt(speed / force);
      for (std::size_t i = 0; i < u.size(); ++i) {
        u[i] = (1 - damping) * u[i] + turn * fx[i], v[i] = (1 - damping) * v[i] + turn * fy[i];
      }
      if (++downhill > 5) step = std::min(1.1 * step, 1.0), damping *= 0.99;
    } else {
      std::fill(u.begin(), u.end(), 0.0), std::fill(v.begin(), v.end(), 0.0);
      step /= 2, damping = 0.1, downhill = 0;
    }
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] += step * fx[i], v[i] += step * fy[i];
      m.position[0][i] += step * u[i], m.position[1][i] += step * v[i];
    }
  }
}

/// Gap at which the whole attraction of a wall and its repulsion of a stiff circle balance, m.
double gap_of_stiff_circle(double zero_force) {
  const double decay = 3.84e6;
  const auto force = [&](double gap) {
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / 20000;
      const double s = std::exp(decay * (zero_force - gap - ring_radius * (1 - std::cos(angle))));
      sum += s * s - s;
    }
    return sum;
  };
  double low = zero_force / 4, high = zero_force;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (force(middle) > 0 ? low : high) = middle;
  }
  return high;
}

}  // namespace

TEST_CASE("a capsule that a wall holds comes to rest where membrane and wall have their least energy", "[walls]") {
  const double depth = GENERATE(1e-8, 3e-8);
  SolverBench bench(scenes + "/viscous-ring.json",
                    {held(depth), ring_at(ring_radius + 0.43e-6), "/numerics/density_factor=20000"});
  bench.start();
  const double spacing = bench.plan.stages[0].units.length;
  bench.step(50000);  // the film drains in 1.1 s at the lesser depth, in 10000 steps
  const double before = gap_of(bench);
  bench.step(10000);
  // At the area that it has now: its tension compresses the lattice's fluid.
  Membranes least = bench.membranes;
  minimise(bench.solver->setup(), least, enclosed_area(least, least.cells[0]));
  const double expected = wall_gap(least, least.cells[0], bench.solver->setup().domain);
  const double rest = gap_of(bench), stiff = gap_of_stiff_circle(0.49e-6);
  std::cout << "ring held by a wall, depth " << depth << " J/m2: gap at rest " << rest * spacing * 1e6 << " um, "
            << rest / expected - 1 << " from the least energy's, " << rest * spacing / stiff - 1
            << " from a stiff circle's (" << stiff * 1e6 << " um); moved " << (rest - before) / rest
            << " in the last sixth\n";
  CHECK(rest == Approx(expected).epsilon(0.002));
  CHECK(std::abs(rest - before) < 1e-3 * rest);
  CHECK(rest * spacing < 0.49e-6);  // farther parts pull
}

TEST_CASE("what a cell loses that a wall draws near is what viscosity takes", "[walls][energy]") {
  const std::vector<std::string> corrections =
      GENERATE(std::vector<std::string>{},
               std::vector<std::string>{"/numerics/slip_correction=true", "/numerics/area_correction=true"});
  SolverBench bench(scenes + "/viscous-ring.json",
                    with(with(lattice(10), corrections),
                         {held(5.2e-8, "1 um"), ring_at(ring_radius + 1.6e-6), "/numerics/density_factor=75"}));
  bench.start();
  const auto ledger = [&] {
    bench.solver->fluid().settle();
    return observe_energy(*bench.solver, bench.plan.stages[0].units);
  };
  const double time = bench.plan.stages[0].units.time;
  bench.step(2000);
  bench.forces();
  const EnergySnapshot first = ledger();
  EnergySnapshot before = first;
  const double gap = gap_of(bench);
  double lost = 0;
  for (int i = 0; i < 20000; ++i) {
    bench.solver->advance();
    bench.forces();
    const EnergySnapshot now = ledger();
    lost += (now.viscous_dissipation + before.viscous_dissipation) / 2 * time;
    before = now;
  }
  const double dropped = first.total - before.total;
  std::cout << "ring drawn to a wall" << (corrections.empty() ? "" : ", corrected") << ": gap from " << gap << " to "
            << gap_of(bench) << " spacings, interaction from " << first.interaction << " to " << before.interaction
            << " J/m, lost over dropped - 1: " << lost / dropped - 1 << "\n";
  CHECK(first.interaction - before.interaction > dropped / 2);  // it is the wall's energy that is lost
  CHECK(dropped > 0);
  CHECK(std::abs(lost / dropped - 1) < (corrections.empty() ? 1e-3 : 1e-2));
}

TEST_CASE("what either wall does is the mirror image of what the other does", "[walls]") {
  const auto run = [](bool upper) {
    const double y = ring_radius + 1.2e-6;
    auto bench = std::make_unique<SolverBench>(
        scenes + "/viscous-ring.json", with(lattice(10), {held(5.2e-8, "1 um"), ring_at(upper ? 12.8e-6 - y : y)}));
    bench->start();
    bench->step(3000);
    return bench;
  };
  const auto lower = run(false), upper = run(true);
  const Eigen::Vector2d a = centroid(lower->membranes, lower->membranes.cells[0]),
                        b = centroid(upper->membranes, upper->membranes.cells[0]);
  const double moved = a.y() - (ring_radius + 1.2e-6) / 0.4e-6 + 0.5;
  std::cout << "ring beside either wall: moved " << moved << " spacings, mirrored to " << a.y() + b.y() - 31 << "\n";
  CHECK(moved < -0.01);
  CHECK(std::abs(a.y() + b.y() - 31) < 1e-9);
}

TEST_CASE("the walls' shear stress is that of the flow and of the cell's particle stress, whatever a wall does to it",
          "[walls]") {
  SolverBench bench(
      scenes + "/viscous-ring.json",
      with(lattice(10),
           {held(5e-7, "1 um"), ring_at(ring_radius + 1.2e-6),
            R"(/stages=[{"name": "shear", "shear_rate": "20 1/s", "strain": 10, "start": "developed"}])"}));
  bench.start();
  bench.solver->start();
  const scene::StageSetting& stage = bench.plan.stages[0];
  bench.step(std::lround(8 / stage.shear_rate));
  const auto look = [&] {
    bench.forces();
    bench.solver->fluid().settle();
    const auto wall = bench.solver->fluid().wall_stress();
    const double stress = viscosity_of(stage.tau) * stage.shear_rate;
    const double walls = (wall.lower - wall.upper) / 2 / stress - 1;
    const double particle = particle_stress(bench.membranes, bench.scene, viscosity_of(stage.tau)).xy / stress;
    const double residual =
        Observer::momentum_residual(bench.membranes, bench.solver->cell_tasks()->force_from_outside());
    const double without = Observer::momentum_residual(bench.membranes);
    bench.solver->advance();
    std::cout << "sheared ring, held: gap " << gap_of(bench) << " spacings, viscosity - 1 by the walls " << walls
              << ", by the particle " << particle << ", momentum residual " << residual << " (" << without
              << " without what walls do)\n";
    CHECK(walls == Approx(particle).epsilon(0.003));
    CHECK(particle > 0.01);
    CHECK(residual < 1e-12);
    CHECK(without > 1e-3);
  };
  look();
  bench.step(std::lround(2 / stage.shear_rate));
  look();
}

TEST_CASE("at rest the total energy of a cell that a wall holds never grows, and tables tell its gap",
          "[walls][energy]") {
  const SceneRun run = run_scene(scenes + "/viscous-ring.json",
                                 {held(5.2e-8), ring_at(ring_radius + 0.7e-6),
                                  R"(/stages=[{"name": "first", "duration": "0.1 s", "density_factor": 1000},
                   {"name": "second", "duration": "0.05 s", "density_factor": 300}])",
                                  R"(/output={"cells": {"seconds": 0.002}})"});
  const auto total = run.series_column("total_energy_J_per_m"),
             interaction = run.series_column("interaction_energy_J_per_m"), gap = run.column("wall_gap_m");
  std::cout << "ring beside a wall: gap from " << gap.front() << " to " << gap.back() << " m, total energy from "
            << total.front() << " to " << total.back() << " J/m: " << run.summary["energy"].dump() << "\n";
  CHECK(gap.front() == Approx(0.7e-6).epsilon(0.005));  // the lowest node lies up to half a side off
  CHECK(gap.back() < gap.front());
  CHECK(interaction.back() < interaction.front());
  CHECK(total.back() < total.front());
  CHECK(run.summary["energy"]["unknown"].is_null());
  CHECK(run.summary["energy"]["largest_growth_at_rest_relative"].get<double>() < 1e-5);
  CHECK(run.summary["conservation"]["momentum_residual"].get<double>() < 1e-12);
}
