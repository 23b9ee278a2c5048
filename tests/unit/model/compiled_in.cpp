// Models compiled into the program: what their parameters say, who owns them, and what is refused.
#include <catch2/catch.hpp>
#include <numbers>

#include "core/contact/interactions.hpp"
#include "core/membrane/membrane_forces.hpp"
#include "unit/cell_fixture.hpp"
#include "unit/fake_models.hpp"

using namespace rouleau::core;
using namespace rouleau::test;
using Catch::Matchers::Contains;

namespace {

constexpr int segments = 64;
constexpr double radius = 20, gap = 1;

double sum_of_sizes(const Membranes& m, const CellRange& cell) {
  double sum = 0;
  for (int i = cell.first; i < cell.end(); ++i) sum += std::hypot(m.force[0][i], m.force[1][i]);
  return sum;
}

}  // namespace

TEST_CASE("a stretched ring of springs pulls every node inwards by twice the tension times the sine of half its turn") {
  Membranes m = mating_circles(radius, gap, segments, 0, 1.25);
  MembraneForces forces(m, {.laws = {{fake_law<Spring>(0.4)}, {fake_law<Spring>(0.4)}}});
  forces.run({}, m);
  const double expected = 2 * 0.4 * 0.25 * std::sin(std::numbers::pi / segments);
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    const double r = std::hypot(m.position[0][i], m.position[1][i]);
    REQUIRE(m.force[0][i] == Approx(-expected * m.position[0][i] / r).margin(1e-14));
    REQUIRE(m.force[1][i] == Approx(-expected * m.position[1][i] / r).margin(1e-14));
  }
}

TEST_CASE("a constant potential between two rings presses on each with the force times their mean length") {
  Membranes m = mating_circles(radius, gap, segments, 0);
  Interactions<2> forces(m, {{{0, 1}, constant_force(0.3, 2 * gap)}}, periodic_box(1000));
  for (int phase = 0; phase < Interactions<2>::phases; ++phase) forces.run({}, phase, m);
  // Up to the corners of the polygons: (pi / segments)^2 / 2.
  const double mean = segments * (m.types[0]->rest_weight[0] + m.types[1]->rest_weight[0]) / 2;
  for (const CellRange& cell : m.cells) CHECK(sum_of_sizes(m, cell) == Approx(0.3 * mean).epsilon(2e-3));
  CHECK(m.force[0][0] < 0);         // the inner ring's first node, at angle 0: inwards
  CHECK(m.force[0][segments] > 0);  // the outer ring's
}

TEST_CASE("a law without a number leaves no node with a force") {
  Membranes m = mating_circles(radius, gap, segments, 0);
  const MembraneLaws laws = {fake_law<Spring>(0.4), fake_law<NoNumber>(0)};
  MembraneForces forces(m, {.laws = {laws, laws}});
  forces.run({}, m);
  for (const double force : m.force[0]) REQUIRE(std::isnan(force));
}

TEST_CASE("a model that refuses its parameters is refused in its own words") {
  CHECK_THROWS_WITH(fake_law<Refusing>(1), Contains("\"fake\" could not be made: ") && Contains("no modulus is good"));
}

TEST_CASE("a parameter that is not given is refused by its name") {
  CHECK_THROWS_WITH(membrane_law(rouleau::membrane<Spring>("spring", "1"), {}), Contains("modulus"));
}

TEST_CASE("a model of another kind is refused") {
  CHECK_THROWS_WITH(membrane_law(rouleau::interaction<ConstantForce>("constant", "1"), {}), Contains("another kind"));
  CHECK_THROWS_WITH(potential(rouleau::membrane<Spring>("spring", "1"), {}), Contains("another kind"));
}

TEST_CASE("an instance lives as long as the last of its handles") {
  REQUIRE(Counted::alive == 0);
  {
    const MembraneLaw first = fake_law<Counted>(1), second = fake_law<Counted>(2), again = first;
    CHECK(Counted::alive == 2);
  }
  CHECK(Counted::alive == 0);
  MembraneLaw copy;
  copy = fake_law<Counted>(3);
  CHECK(Counted::alive == 1);
}
