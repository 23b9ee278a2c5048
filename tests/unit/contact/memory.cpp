// Membranes that remember: tension by rate, stepped implicitly, and laws with state of their own.
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/membrane/membrane_forces.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

MembraneLaw viscous(double viscosity) { return law("viscous", {viscosity, 0}); }
MembraneLaw maxwell(double modulus, double relaxation_time) {
  return law("standard-linear-solid", {modulus, relaxation_time});
}

MembraneForces forces_with(Membranes& m, MembraneLaws laws, double tension_unit = 1) {
  return {m, {.laws = {std::move(laws)}, .tension_unit = tension_unit}};
}

/// d length / dt of every segment.
std::vector<double> length_rates(const Membranes& m) {
  std::vector<double> rates;
  for (const CellRange& cell : m.cells) {
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto k = static_cast<std::size_t>(i), n = static_cast<std::size_t>(cell.next(i));
      const double dx = m.position[0][n] - m.position[0][k], dy = m.position[1][n] - m.position[1][k];
      rates.push_back((dx * (m.velocity[0][n] - m.velocity[0][k]) + dy * (m.velocity[1][n] - m.velocity[1][k])) /
                      std::hypot(dx, dy));
    }
  }
  return rates;
}

void set_random_velocities(Membranes& m, std::mt19937& random, double size) {
  std::normal_distribution<double> normal(0, size);
  for (auto* velocity : {&m.velocity[0], &m.velocity[1]}) {
    for (double& v : *velocity) v = normal(random);
  }
}

/// Every length of the membrane times a factor.
void scale(Membranes& m, double factor) {
  for (auto* position : {&m.position[0], &m.position[1]}) {
    for (double& p : *position) p *= factor;
  }
}

const std::vector<double>& state(const Membranes& m, const char* name) {
  const auto named = [name](const core::ElementState& state) { return state.cell_type == 0 && state.name == name; };
  return std::find_if(m.state.begin(), m.state.end(), named)->value;
}

}  // namespace

TEST_CASE("the implicit tension of a steady motion becomes viscosity times rate") {
  auto random = generator(101);
  Membranes m = biconcave_cells({{100, 60, 0.4}}, 99);
  deform(m, random, 3, 0.1);
  set_random_velocities(m, random, 1e-3);
  const double viscosity = GENERATE(0.1, 10.0);
  MembraneForces forces = forces_with(m, {viscous(viscosity)});
  // What is missing falls by a factor of at least 1 - 1/(1 + 16 viscosity/length) in a step.
  for (int step = 0; step < 10000; ++step) forces.run({}, m);
  const std::vector<double> tension = forces.tensions(m, 0);
  const std::vector<double> rates = length_rates(m);
  double largest = 0;
  for (const double t : tension) largest = std::max(largest, std::abs(t));
  for (std::size_t i = 0; i < tension.size(); ++i) {
    const std::size_t n = i + 1 < tension.size() ? i + 1 : 0;
    const double length = std::hypot(m.position[0][n] - m.position[0][i], m.position[1][n] - m.position[1][i]);
    REQUIRE(tension[i] == Approx(viscosity * rates[i] / length).margin(1e-11 * largest));
  }
}

TEST_CASE("whatever the motion, a viscous membrane never gives back more than it has taken") {
  // Random velocities, new in every step: the worst that a step taken with the velocities of the last one can meet.
  auto random = generator(102);
  const double viscosity = GENERATE(0.01, 1.0, 100.0, 7000.0);
  Membranes m = biconcave_cells({{100, 60, 0.4}}, 99);
  deform(m, random, 3, 0.1);
  MembraneForces forces = forces_with(m, {viscous(viscosity)});
  double work = 0;
  for (int step = 0; step < 2000; ++step) {
    set_random_velocities(m, random, 1e-3);
    forces.run({}, m);
    const std::vector<double> rates = length_rates(m);
    for (std::size_t i = 0; i < rates.size(); ++i) work += state(m, "rate_tension")[i] * rates[i];
    REQUIRE(work > 0);
  }
}

TEST_CASE("membrane viscosity costs rigid motion nothing and leaves no net force and torque") {
  auto random = generator(103);
  Membranes m = biconcave_cells({{100, 60, 0.4}, {160, 70, 2}});
  deform(m, random, 3, 0.1);
  MembraneForces forces = forces_with(m, {viscous(200)});
  SECTION("rigid motion") {
    for (std::size_t i = 0; i < m.position[0].size(); ++i) {
      m.velocity[0][i] = 0.01 - 0.002 * m.position[1][i];
      m.velocity[1][i] = -0.02 + 0.002 * m.position[0][i];
    }
    forces.run({}, m);
    // Rates are differences of velocities of size 0.4: rounding, times the viscosity over a length near 1.
    for (const double force : m.force[0]) REQUIRE(std::abs(force) < 200 * 1e-15);
  }
  SECTION("any motion") {
    for (int step = 0; step < 10; ++step) {
      set_random_velocities(m, random, 1e-3);
      forces.run({}, m);
    }
    const ForceSums sums = force_sums(m);
    REQUIRE(sums.size > 0);
    CHECK(std::abs(sums.x) < 1e-12 * sums.size);
    CHECK(std::abs(sums.torque) < 1e-12 * sums.lever);
  }
}

TEST_CASE("the tension of a Maxwell branch falls exponentially after a step of stretch") {
  Membranes m = biconcave_cells({{100, 60, 0.4}});
  const double time = GENERATE(0.3, 5.0, 1e4);  // in steps
  MembraneForces forces = forces_with(m, {maxwell(0.2, time)});
  forces.run({}, m);
  scale(m, 1.1);
  std::vector<double> tension;
  for (int step = 1; step <= 20; ++step) {
    forces.run({}, m);
    tension = forces.tensions(m, 0);
    // Differences of stretches near 1: an absolute error of a few 1e-16 in each.
    for (const double t : tension)
      REQUIRE(t == Approx(0.2 * 0.1 * std::exp(-step / time)).epsilon(1e-12).margin(1e-16));
  }
}

TEST_CASE("a Maxwell branch is a spring when it relaxes slowly and a dashpot when it relaxes fast") {
  Membranes m = biconcave_cells({{0, 0, 0}});
  const double rate = 1e-4;
  std::vector<double> tension;
  SECTION("slowly") {
    MembraneForces forces = forces_with(m, {maxwell(0.2, 1e12)});
    scale(m, 1.07);
    forces.run({}, m);
    tension = forces.tensions(m, 0);
    for (const double t : tension) REQUIRE(t == Approx(0.2 * 0.07));
  }
  SECTION("fast") {
    MembraneForces forces = forces_with(m, {maxwell(0.2, 10)});
    for (int step = 0; step < 400; ++step) {
      for (std::size_t i = 0; i < m.position[0].size();
           ++i) {  // d stretch / dt = rate: every length grows by rate in a step
        m.velocity[0][i] = rate * m.position[0][i] / (1 + rate * step);
        m.velocity[1][i] = rate * m.position[1][i] / (1 + rate * step);
        m.position[0][i] += m.velocity[0][i];
        m.position[1][i] += m.velocity[1][i];
      }
      forces.run({}, m);
    }
    tension = forces.tensions(m, 0);
    for (const double t : tension) REQUIRE(t == Approx(0.2 * 10 * rate).epsilon(1e-9));  // e^-40 is left of the start
  }
}

TEST_CASE("the work done on a Maxwell branch is what its spring holds and its dashpot loses, to second order") {
  const double modulus = 0.2, time = 300;
  const auto missing = [&](int steps_per_cycle) {
    Membranes m = biconcave_cells({{0, 0, 0}});
    const double cycle = 2000, dt = cycle / steps_per_cycle;
    MembraneForces forces = forces_with(m, {maxwell(modulus, time / dt)});
    double work = 0, loss = 0, before = 0, stretch = 1;
    const double rest = m.cells[0].rest_perimeter;
    for (int step = 1; step <= steps_per_cycle; ++step) {
      const double next = 1 + 0.1 * std::sin(6.283185307179586 * step / steps_per_cycle);
      for (std::size_t i = 0; i < m.position[0].size(); ++i) {
        m.velocity[0][i] = m.position[0][i] * (next / stretch - 1);
        m.velocity[1][i] = m.position[1][i] * (next / stretch - 1);
      }
      scale(m, next / stretch);
      // Velocities are the displacement of the last step, along the same directions.
      forces.run({}, m);
      const std::vector<double> tension = forces.tensions(m, 0);
      work += rest * (before + tension[0]) / 2 * (next - stretch);
      loss += rest * (before * before + tension[0] * tension[0]) / 2 / (modulus * time) * dt;
      before = tension[0];
      stretch = next;
    }
    return (work - loss - forces.energies(m).tension) / work;
  };
  const double coarse = std::abs(missing(100)), fine = std::abs(missing(200));
  CHECK(coarse < 1e-2);
  CHECK(coarse / fine == Approx(4).epsilon(0.1));
}

TEST_CASE("who looks at energies and tensions does not make time pass") {
  auto random = generator(104);
  Membranes m = biconcave_cells({{100, 60, 0.4}});
  deform(m, random, 3, 0.1);
  set_random_velocities(m, random, 1e-3);
  MembraneForces forces = forces_with(m, {neo_hookean(0.1), maxwell(0.2, 3), viscous(5)});
  for (int step = 0; step < 5; ++step) forces.run({}, m);
  const std::vector<ElementState> before = m.state;
  const std::vector<double> first = forces.tensions(m, 0);
  const double energy = forces.energy(m);
  const std::vector<double> second = forces.tensions(m, 0);
  CHECK(first == second);
  CHECK(forces.energy(m) == energy);
  REQUIRE(m.state.size() == 2);
  for (std::size_t k = 0; k < before.size(); ++k) CHECK(m.state[k].value == before[k].value);
  // The tensions seen are those that made the forces: segment i pulls node i by T_i t_i and node i + 1 by -T_i t_i.
  double worst = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::size_t b = i > 0 ? i - 1 : first.size() - 1, n = i + 1 < first.size() ? i + 1 : 0;
    const auto along = [&](std::size_t from, std::size_t to) {
      return (m.position[0][to] - m.position[0][from]) /
             std::hypot(m.position[0][to] - m.position[0][from], m.position[1][to] - m.position[1][from]);
    };
    worst = std::max(worst, std::abs(m.force[0][i] - first[i] * along(i, n) + first[b] * along(b, i)));
  }
  CHECK(worst < 1e-13);
}

TEST_CASE("two branches of one type and the same law of another type each remember for themselves") {
  Membranes m = biconcave_cells({{100, 60, 0.4}, {160, 70, 2}});
  m.cells[1].type = 1;
  MembraneForces forces(m, {.laws = {{maxwell(0.2, 5), maxwell(0.3, 50)}, {maxwell(0.2, 500)}}});
  REQUIRE(m.state.size() == 3);
  scale(m, 1.1);
  for (int step = 0; step < 4; ++step) forces.run({}, m);
  CHECK(forces.tensions(m, 0)[7] == Approx(0.02 * std::exp(-4 / 5.0) + 0.03 * std::exp(-4 / 50.0)));
  CHECK(forces.tensions(m, 1)[7] == Approx(0.02 * std::exp(-4 / 500.0)));
}

TEST_CASE("state goes on in a stage with another time step") {
  // One unit of time is 1 s first and 0.25 s then; viscosities, in kg/s, count 4 times less, tensions, in kg/s2, 16 times.
  Membranes m = biconcave_cells({{100, 60, 0.4}});
  MembraneForces first = forces_with(m, {maxwell(0.2, 5), viscous(3)});
  scale(m, 1.1);
  for (int step = 0; step < 3; ++step) first.run({}, m);
  for (ElementState& variable : m.state) {
    if (variable.name == "rate_tension") variable.value.assign(m.position[0].size(), 0.32);
  }
  MembraneForces second = forces_with(m, {maxwell(0.2 / 16, 5 * 4), viscous(3.0 / 4)}, 16);
  REQUIRE(m.state.size() == 2);
  CHECK(state(m, "rate_tension")[5] == Approx(0.02));
  m.state[1].value.assign(m.position[0].size(), 0.0);
  for (int step = 0; step < 8; ++step) second.run({}, m);  // 2 s more
  const std::vector<double> tension = second.tensions(m, 0);
  for (const double t : tension) REQUIRE(16 * t == Approx(0.02 * std::exp(-5 / 5.0)));
}

TEST_CASE("forces and state are the same to the last bit for one, two and three workers") {
  auto random = generator(105);
  Membranes start = biconcave_cells({{0, -19, 0.05}, {2, 0, 0.0}, {-1, 18, -0.08}, {30, 30, 1.3}}, 93);
  deform(start, random, 2, 0.05);
  std::vector<Membranes> results;
  for (const int workers : {1, 2, 3}) {
    Membranes m = start;
    MembraneForces forces = forces_with(m, {neo_hookean(0.1), maxwell(0.2, 7), viscous(50), bending(0.1)});
    for (int step = 0; step < 30; ++step) {
      run_pass(workers, [&](Worker worker) { forces.run(worker, m); });
      for (std::size_t i = 0; i < m.position[0].size(); ++i) {
        m.position[0][i] += m.velocity[0][i] = 0.02 * m.force[0][i];
        m.position[1][i] += m.velocity[1][i] = 0.02 * m.force[1][i];
      }
    }
    results.push_back(m);
  }
  for (std::size_t k = 1; k < results.size(); ++k) {
    CHECK(results[k].position[0] == results[0].position[0]);
    CHECK(results[k].force[1] == results[0].force[1]);
    for (std::size_t v = 0; v < 2; ++v) CHECK(results[k].state[v].value == results[0].state[v].value);
  }
}
