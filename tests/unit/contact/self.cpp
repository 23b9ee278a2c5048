// Potentials within a membrane: gradients, sums known from elsewhere, and shapes that must not feel them.
#include "core/contact/interactions.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "unit/cell_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

Interactions<2> within(Membranes& m, const core::Potential& potential) {
  return {m, {}, periodic_box(1000), {{0, potential}}};
}

void run(Interactions<2>& self, Membranes& m, int workers = 1) {
  for (const int phase : {0, 1, 2}) run_pass(workers, [&](Worker worker) { self.run(worker, phase, m); });
}

core::Potential repulsion(double strength, double cutoff) { return potential("repulsion", {strength, cutoff}); }

Membranes polygon(std::vector<double> x, std::vector<double> y) {
  Membranes m;
  add_shape(m, make_rest_shape(std::move(x), std::move(y)));
  return m;
}

/// Two faces a distance apart with `length` segments each, one spacing long, closed by half circles of segments as
/// long.
Membranes flat_cell(int length, double apart) {
  std::vector<double> x, y;
  const int steps = static_cast<int>(std::lround(std::numbers::pi * apart / 2));
  const auto face = [&](double from, double direction, double height) {
    for (int i = 0; i < length; ++i) x.push_back(from + direction * i), y.push_back(height);
  };
  const auto cap = [&](double center, double first) {
    for (int i = 0; i < steps; ++i) {
      const double angle = first + std::numbers::pi * i / steps;
      x.push_back(center + apart / 2 * std::cos(angle)), y.push_back(apart / 2 * std::sin(angle));
    }
  };
  face(0, 1, -apart / 2), cap(length, -std::numbers::pi / 2);
  face(length, -1, apart / 2), cap(0, std::numbers::pi / 2);
  return polygon(std::move(x), std::move(y));
}

Membranes circle(double radius, int sides) {
  std::vector<double> x, y;
  for (int i = 0; i < sides; ++i) {
    x.push_back(radius * std::cos(2 * std::numbers::pi * i / sides));
    y.push_back(radius * std::sin(2 * std::numbers::pi * i / sides));
  }
  return polygon(std::move(x), std::move(y));
}

}  // namespace

TEST_CASE("forces within a membrane are minus the gradient of their energy, without net force or torque") {
  const unsigned seed = GENERATE(71u, 72u);
  auto random = generator(seed);
  Membranes m = biconcave_cells({{40, 30, 0.4}, {100, 30, 1.9}});
  deform(m, random, 1.5, 0.02);
  const core::Potential acts = GENERATE(0, 1) == 0 ? repulsion(0.4, 7) : morse(0.2, 0.75, 2.5, 18);
  Interactions<2> self = within(m, acts);
  run(self, m);
  const ForceSums sums = force_sums(m);
  REQUIRE(sums.size > 0.1);
  CHECK(std::abs(sums.x) + std::abs(sums.y) < 1e-13 * sums.size);
  CHECK(std::abs(sums.torque) < 1e-13 * sums.lever);
  CHECK(gradient_error(
            m, [&] { return self.energy(m); }, 1e-5) < 1e-7);
}

TEST_CASE("the faces of a flat cell repel each other as those of two cells at the same distance") {
  const double apart = 3;
  Membranes one = flat_cell(60, apart);
  Interactions<2> self = within(one, repulsion(0.3, 4));
  run(self, one);
  // The lower cell of two, whose upper face is as long.
  Membranes two = flat_cell(60, 20);
  add_cell(two, 0, 0, 20 + apart, 0);
  Interactions<2> other(two, {{{0, 0}, repulsion(0.3, 4)}}, periodic_box(1000));
  run(other, two);
  const auto force_at = [](const Membranes& m, double x, double y) {
    for (int i = 0; i < m.node_count(); ++i)
      if (m.position[0][i] == x && std::abs(m.position[1][i] - y) < 1e-12) return m.force[1][i];
    return std::nan("");
  };
  for (double x = 15; x <= 45; x += 1) {
    REQUIRE(force_at(one, x, apart / 2) == Approx(force_at(two, x, 10 + apart)).epsilon(1e-12));
    REQUIRE(force_at(one, x, -apart / 2) == Approx(-force_at(one, x, apart / 2)).epsilon(1e-12));
  }
  CHECK(force_at(one, 30, apart / 2) == Approx(3 * 0.3 / 4 * (1 - 3.0 / 4) * (1 - 3.0 / 4)).epsilon(1e-12));
}

TEST_CASE("a circle wider than the cutoff does nothing to itself, and one that was folded up is pushed open") {
  Membranes wide = circle(20, 126);
  Interactions<2> none = within(wide, repulsion(0.3, 38));
  run(none, wide);
  CHECK(force_sums(wide).size == 0);
  CHECK(none.energy(wide) == 0);
  Membranes narrow = circle(20, 126);
  Interactions<2> some = within(narrow, repulsion(0.3, 38));
  for (int i = 0; i < narrow.node_count(); ++i)
    narrow.position[0][i] *= 0.6;  // now 24 wide, as many spacings apart as before
  run(some, narrow);
  for (int i = 0; i < narrow.node_count(); ++i)
    if (std::abs(narrow.position[0][i]) > 8) REQUIRE(narrow.force[0][i] * narrow.position[0][i] > 0);
}

TEST_CASE(
    "a potential within a membrane acts on cells of its type alone, whatever other cells do and how many workers") {
  auto random = generator(73);
  Membranes m = biconcave_cells({{40, 30, 0}, {40, 34, 0}, {100, 30, 1}});
  m.cells[2].type = 1;
  deform(m, random, 1.5);
  Membranes again = m, alone = biconcave_cells({{40, 30, 0}});
  for (int i = 0; i < alone.node_count(); ++i)
    alone.position[0][i] = m.position[0][i], alone.position[1][i] = m.position[1][i];
  Interactions<2> self = within(m, repulsion(0.4, 7)), same = within(again, repulsion(0.4, 7)),
                  first = within(alone, repulsion(0.4, 7));
  run(self, m), run(same, again, 3), run(first, alone);
  CHECK(m.force[0] == again.force[0]);
  CHECK(m.force[1] == again.force[1]);
  for (int i = 0; i < m.node_count(); ++i) {
    if (i < m.cells[0].end()) REQUIRE(m.force[1][i] == alone.force[1][i]);
    if (i >= m.cells[2].first) REQUIRE(m.force[1][i] == 0);
  }
  CHECK(force_sums(alone).size > 0);
}

TEST_CASE("of several potentials within a membrane the longest cutoff says which parts may touch") {
  Membranes one = flat_cell(60, 3), both = one;
  Interactions<2> shorter = within(one, repulsion(0.3, 4));
  Interactions<2> with_longer(both, {}, periodic_box(1000), {{0, repulsion(0.3, 4)}, {0, repulsion(1e-30, 10)}});
  run(shorter, one), run(with_longer, both);
  // Along the outline a node of the lower face at x is 2 x + 3 pi/2 away from the one above it.
  CHECK(std::abs(one.force[1][3]) > 1e-3);
  CHECK(std::abs(both.force[1][3]) < 1e-20);
  CHECK(both.force[1][30] == Approx(one.force[1][30]).epsilon(1e-12));
}

TEST_CASE("what remembers or looks at velocities does not act within a membrane") {
  Membranes m = biconcave_cells({{40, 30, 0}});
  const core::Potential bonds = potential("bridging", {0.7, 0.3, 2.5, 0.02, 0.03, 0.4, 0.9, 8});
  CHECK_THROWS_WITH(within(m, bonds), Catch::Matchers::Contains("bridging"));
}

TEST_CASE("cells smaller than what keeps parts apart, and nodes on the other face, give no NaN") {
  Membranes small = circle(2, 12);
  Interactions<2> self = within(small, repulsion(0.3, 10));
  run(self, small);
  CHECK(force_sums(small).size == 0);
  Membranes flat = flat_cell(60, 3);
  Interactions<2> touching = within(flat, repulsion(0.3, 4));
  for (double& y : flat.position[1]) y = 0;
  run(touching, flat);
  CHECK(std::isfinite(force_sums(flat).size));
  CHECK(touching.energy(flat) > 0);
}
