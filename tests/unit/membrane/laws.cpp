// Every shipped membrane law as forces on a closed outline: gradients, balances, rest, rigid motion; and what a
// constant rest curvature changes.
#include <catch2/catch.hpp>
#include <iostream>

#include "core/contact/interactions.hpp"
#include "core/membrane/geometry.hpp"
#include "core/membrane/membrane_forces.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

struct NamedLaws {
  std::string name;
  MembraneLaws laws;
  bool at_rest;  ///< no force on the shape the cell was created with
};

std::vector<NamedLaws> shipped_laws() {
  return {{"neo-hookean, clamped", {law("neo-hookean", {0.1, 1})}, true},
          {"skalak, free", {law("skalak", {0.1, 2, 0})}, true},
          {"skalak, clamped", {law("skalak", {0.1, 2, 1})}, true},
          {"hooke", {law("hooke", {0.1, 0.3})}, true},
          {"inextensible", {law("inextensible", {2})}, true},
          {"bending about zero", {law("bending", {0.5, 1, 0})}, false},
          {"bending about a value", {law("bending", {0.5, 2, 0.05})}, false},
          {"area", {law("area", {0.1, 1})}, true},
          {"area, smaller", {law("area", {0.1, 0.8})}, false},
          {"perimeter", {law("perimeter", {0.3, 1})}, true},
          {"perimeter, longer", {law("perimeter", {0.3, 1.1})}, false},
          {"all kinds of elements",
           {law("skalak", {0.1, 2, 0}), bending(0.5), law("area", {0.1, 0.9}), law("perimeter", {0.3, 1.1})},
           false}};
}

void turn_and_move(Membranes& m, double angle, double dx, double dy) {
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    const double x = m.position[0][i], y = m.position[1][i];
    m.position[0][i] = dx + std::cos(angle) * x - std::sin(angle) * y;
    m.position[1][i] = dy + std::sin(angle) * x + std::cos(angle) * y;
  }
}

double largest_force(const Membranes& m) {
  double most = 0;
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    most = std::max(most, std::hypot(m.force[0][i], m.force[1][i]));
  return most;
}

/// Largest stress along the membrane that a Morse well of the given width puts against sliding, over its strongest
/// attraction. 31 segments are one spacing long each.
double friction(double width, int segments = 31) {
  constexpr double radius = 5, gap = 2.5;
  constexpr int places = 40;
  double most = 0;
  for (int k = 0; k < places; ++k) {
    Membranes m = mating_circles(radius, gap, segments, 2 * 3.141592653589793 / segments * k / places);
    Interactions<2> forces(m, {{{0, 1}, morse(1, 2 / width, gap, 6)}}, periodic_box(10000));
    for (int phase = 0; phase < Interactions<2>::phases; ++phase) forces.run({}, phase, m);
    double torque = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(segments); ++i)
      torque += m.position[0][i] * m.force[1][i] - m.position[1][i] * m.force[0][i];
    most = std::max(most, std::abs(torque) / radius / (2 * 3.141592653589793 * radius));
  }
  return most * width;
}

}  // namespace

TEST_CASE(
    "corners of membranes that slide along each other catch in a narrow well, in inverse proportion to its width") {
  double before = 0;
  for (const double width : {2.66, 1.33, 0.665, 0.3325, 0.16625}) {
    const double found = friction(width);
    REQUIRE(found > 0);
    std::cout << "well of " << width << " spacings: sliding on a radius of 5 spacings meets " << 100 * found
              << " % of the strongest attraction\n";
    // Corners stand h^2/(8 R) = 0.025 spacings out of their circle: the law holds while that is small against the
    // width.
    if (before > 0 && width > 0.3) CHECK(found / before == Approx(2).epsilon(0.06));
    before = found;
  }
  // The energy per length goes with the square of the corners' height, h^4, its slope along the membrane with h^3.
  CHECK(friction(2.66) / friction(2.66, 62) == Approx(8).epsilon(0.06));
}

TEST_CASE("forces of every shipped law are minus the gradient of its energy, without net force or torque") {
  auto random = generator(61);
  Membranes m = biconcave_cells({{10, 6, 0.4}, {70, 9, 2}}, 93);
  deform(m, random, 4, 0.1);
  for (NamedLaws& entry : shipped_laws()) {
    CAPTURE(entry.name);
    MembraneForces forces(m, {.laws = {entry.laws}});
    forces.run({}, m);
    // Central differences: truncation 1e-4^2, rounding 1e-16 E / (1e-4 F).
    CHECK(gradient_error(
              m, [&] { return forces.energy(m); }, 1e-4) < 1e-7);
    const ForceSums sums = force_sums(m);
    REQUIRE(sums.size > 0);
    CHECK(std::abs(sums.x) < 1e-12 * sums.size);
    CHECK(std::abs(sums.y) < 1e-12 * sums.size);
    CHECK(std::abs(sums.torque) < 1e-12 * sums.lever);
  }
}

TEST_CASE("a cell that is turned and moved as a whole stores no energy and feels no force") {
  for (NamedLaws& entry : shipped_laws()) {
    if (!entry.at_rest) continue;
    CAPTURE(entry.name);
    Membranes m = biconcave_cells({{10, 6, 0.4}});
    const Membranes before = m;
    turn_and_move(m, 2.1, 30, -12);
    MembraneForces forces(m, {.laws = {entry.laws}});
    forces.run({}, m);
    // Stretches are 1 to a few epsilon of the positions, 1e-14; moduli are at most 2.
    CHECK(largest_force(m) < 1e-12);
    CHECK(forces.energy(m) < 1e-20);
  }
}

TEST_CASE("rigid motion of a deformed cell turns its forces with it and costs nothing") {
  auto random = generator(62);
  Membranes start = biconcave_cells({{10, 6, 0.4}});
  deform(start, random, 4, 0.1);
  for (NamedLaws& entry : shipped_laws()) {
    CAPTURE(entry.name);
    Membranes a = start, b = start;
    turn_and_move(b, 2.1, 30, -12);
    MembraneForces forces(a, {.laws = {entry.laws}});
    forces.run({}, a);
    forces.run({}, b);
    CHECK(forces.energy(b) == Approx(forces.energy(a)).epsilon(1e-12));
    turn_and_move(b, -2.1, 0, 0);  // its positions no longer matter
    const double c = std::cos(2.1), s = std::sin(2.1), size = largest_force(a);
    for (std::size_t i = 0; i < a.position[0].size(); ++i) {
      REQUIRE(std::abs(c * b.force[0][i] + s * b.force[1][i] - a.force[0][i]) < 1e-11 * size);
      REQUIRE(std::abs(c * b.force[1][i] - s * b.force[0][i] - a.force[1][i]) < 1e-11 * size);
    }
  }
}

TEST_CASE("a constant rest curvature changes the energy by a constant and no force, the initial one changes both") {
  auto random = generator(63);
  Membranes m = biconcave_cells({{10, 6, 0.4}}), other = m;
  const auto forces_of = [](Membranes& membranes, const std::vector<double>& values) {
    MembraneForces forces(membranes, {.laws = {{law("bending", values)}}});
    forces.run({}, membranes);
    return forces.energy(membranes);
  };
  double shift = 0;
  for (int trial = 0; trial < 3; ++trial) {
    deform(m, random, 3);
    other.position[0] = m.position[0], other.position[1] = m.position[1];
    const double zero = forces_of(m, {0.5, 1, 0}), value = forces_of(other, {0.5, 2, 0.05});
    const double size = largest_force(m);
    for (std::size_t i = 0; i < m.position[0].size(); ++i)
      REQUIRE(std::abs(m.force[0][i] - other.force[0][i]) < 1e-12 * size);
    // Eb/2 (kappa0^2 P - 2 kappa0 2 pi), P the rest perimeter: the curvatures of an outline add up to one turn.
    const double constant = 0.25 * (0.05 * 0.05 * m.cells[0].rest_perimeter - 0.1 * 2 * 3.141592653589793);
    CHECK(value - zero == Approx(constant).epsilon(1e-11));
    if (trial > 0) CHECK(value - zero == Approx(shift).epsilon(1e-11));
    shift = value - zero;
    forces_of(other, {0.5, 0, 0});
    double difference = 0;
    for (std::size_t i = 0; i < m.position[0].size(); ++i) {
      difference = std::max(difference, std::abs(m.force[0][i] - other.force[0][i]));
    }
    CHECK(difference > 0.01 * size);
  }
}

TEST_CASE("the stretch of a cell's segments is read off its outline") {
  Membranes m = biconcave_cells({{10, 6, 0.4}});
  const StretchRange rest = stretch_range(m, m.cells[0]);
  CHECK(rest.least == Approx(1).epsilon(1e-13));
  CHECK(rest.most == Approx(1).epsilon(1e-13));
  for (double& x : m.position[0]) x *= 1.25;
  for (double& y : m.position[1]) y *= 1.25;
  CHECK(stretch_range(m, m.cells[0]).least == Approx(1.25).epsilon(1e-13));
  m.position[0][7] += 0.5 * (m.position[0][8] - m.position[0][7]);
  m.position[1][7] += 0.5 * (m.position[1][8] - m.position[1][7]);
  CHECK(stretch_range(m, m.cells[0]).least == Approx(0.625).epsilon(1e-13));
  CHECK(stretch_range(m, m.cells[0]).most > 1.5);
}

TEST_CASE(
    "every shipped potential acts between cells as minus the gradient of its energy, without net force or torque") {
  const std::vector<rouleau::core::Potential> potentials = {potential("lennard-jones-shifted", {0.2, 2.5, 12}),
                                                            potential("repulsion", {0.2, 7})};
  auto random = generator(64);
  Membranes m = biconcave_cells({{0, -18, 0.05}, {2, 0, 0.0}, {-1, 18, -0.08}});
  deform(m, random, 2, 0.02);
  for (const auto& acting : potentials) {
    CAPTURE(acting.id);
    Interactions<2> forces(m, {{{0, 0}, acting}}, periodic_box(10000));
    const auto run = [&] {
      std::fill(m.force[0].begin(), m.force[0].end(), 0.0);
      std::fill(m.force[1].begin(), m.force[1].end(), 0.0);
      for (int phase = 0; phase < Interactions<2>::phases; ++phase) forces.run({}, phase, m);
    };
    run();
    const ForceSums sums = force_sums(m);
    REQUIRE(sums.size > 0);
    CHECK(std::abs(sums.x) < 1e-12 * sums.size);
    CHECK(std::abs(sums.y) < 1e-12 * sums.size);
    CHECK(std::abs(sums.torque) < 1e-12 * sums.lever);
    // Both end smoothly at their cutoffs, so nodes may come and go. At a node whose closest point is about to jump to
    // another segment the energy has a kink; few nodes are at one.
    const auto energy = [&] {
      run();
      return forces.energy(m);
    };
    CHECK(gradient_error(m, energy, 1e-5) < 1e-6);
  }
}
