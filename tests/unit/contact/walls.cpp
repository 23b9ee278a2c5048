// Potentials between cells and walls: gradients, sums known from elsewhere, symmetry, and who is left alone.
#include "core/contact/wall_contacts.hpp"

#include <rouleau/interaction.hpp>

#include <catch2/catch.hpp>
#include <limits>
#include <numbers>

#include "core/contact/interactions.hpp"
#include "core/model/compiled_in.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// Walls at -1/2 and height - 1/2.
core::Domain<2> channel(int height) { return {{200, height}, {true, false}}; }

void run(WallContacts<2>& walls, Membranes& m, int workers = 1) {
  run_pass(workers, [&](Worker worker) { walls.run(worker, m); });
}

core::Potential repulsion(double strength, double cutoff) { return potential("repulsion", {strength, cutoff}); }
core::Potential lennard_jones(double depth, double distance, double cutoff) {
  return potential("lennard-jones", {depth, distance, cutoff});
}

core::Potential bridging_of_walls() { return potential("bridging", {0.7, 0.3, 2.5, 0.02, 0.03, 0.4, 0.9, 8}); }

/// Polygons as they are, with their sides as rest lengths, each of a type of its own.
Membranes polygons(const std::vector<std::vector<std::array<double, 2>>>& outlines) {
  Membranes m;
  for (const auto& outline : outlines) {
    std::vector<double> x, y;
    for (const auto& node : outline) x.push_back(node[0]), y.push_back(node[1]);
    add_shape(m, make_rest_shape(std::move(x), std::move(y)));
  }
  return m;
}
std::vector<std::array<double, 2>> circle(double radius, double x, double y, int sides, double turned = 0) {
  std::vector<std::array<double, 2>> nodes;
  for (int i = 0; i < sides; ++i) {
    const double angle = turned + 2 * std::numbers::pi * i / sides;
    nodes.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return nodes;
}
/// A box from `bottom` to `top`, with a node for every spacing of its outline.
std::vector<std::array<double, 2>> box(int width, double bottom, int height) {
  std::vector<std::array<double, 2>> nodes;
  for (int i = 0; i < width; ++i) nodes.push_back({10.0 + i, bottom});
  for (int i = 0; i < height; ++i) nodes.push_back({10.0 + width, bottom + i});
  for (int i = 0; i < width; ++i) nodes.push_back({10.0 + width - i, bottom + height});
  for (int i = 0; i < height; ++i) nodes.push_back({10.0, bottom + height - i});
  return nodes;
}

}  // namespace

TEST_CASE("forces of walls are minus the gradient of their energy, at either wall and where both are near") {
  const unsigned seed = GENERATE(61u, 62u);
  auto random = generator(seed);
  const int height = GENERATE(24, 90);  // narrower than two cutoffs, and wide
  Membranes m = biconcave_cells({{40, 10.5, 0.02}, {100, height - 11.5, 3.1}});
  deform(m, random, 1, 0.02);
  // Deep cutoffs, so that nodes that come and go do not show; a repulsion ends smoothly.
  const WallInteraction held =
      GENERATE(WallInteraction{0, morse(0.2, 0.75, 2.5, 18)}, WallInteraction{0, repulsion(0.4, 9)},
               WallInteraction{0, lennard_jones(0.2, 2.5, 300)});
  WallContacts<2> walls(m, {held}, channel(height));
  run(walls, m);
  REQUIRE(force_sums(m).size > 0.1);
  CHECK(gradient_error(
            m, [&] { return walls.energy(m); }, 1e-5) < 1e-7);
}

TEST_CASE("a flat membrane holds with a wall what it holds with another membrane at the same distance") {
  // Of the mirror image every node is the closest one, so that both sums have the same terms.
  const double gap = GENERATE(1.5, 2.5, 4.0);
  const core::Potential held = morse(0.2, 0.75, 2.5, 9);
  Membranes before_wall = polygons({box(40, -0.5 + gap, 12)});
  Membranes before_other = polygons({box(40, 30, 12), box(40, 30 - gap - 12, 12)});
  WallContacts<2> wall(before_wall, {{0, held}}, channel(90));
  Interactions<2> other(before_other, {{{0, 1}, held}}, periodic_box(10000));
  for (int phase = 0; phase < Interactions<2>::phases; ++phase) other.run({}, phase, before_other);
  run(wall, before_wall);
  CHECK(wall.energy(before_wall) == Approx(other.energy(before_other)).epsilon(1e-13));
  CHECK(std::abs(wall.energy(before_wall)) > 1);
  // And every node of the face feels the same; at the foot of a side the closest point of the other changes its side.
  for (int i = 1; i < 40; ++i) REQUIRE(before_wall.force[1][i] == Approx(before_other.force[1][i]).epsilon(1e-12));
}

TEST_CASE("a circle before a wall is repelled by the integral of the force over its outline") {
  const double radius = 20, gap = 3, strength = 0.4, reach = 9;
  double integral = 0;
  constexpr int parts = 2000000;
  for (int i = 0; i < parts; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / parts, r = gap + radius * (1 - std::cos(angle));
    if (r < reach)
      integral += 3 * strength / reach * std::pow(1 - r / reach, 2) * 2 * std::numbers::pi * radius / parts;
  }
  std::vector<double> errors;
  for (const int sides : {125, 250, 500}) {
    Membranes m = polygons({circle(radius, 60, -0.5 + gap + radius, sides)});
    WallContacts<2> walls(m, {{0, repulsion(strength, reach)}}, channel(90));
    run(walls, m);
    CHECK(walls.net_force(m) == Approx(force_sums(m).y).epsilon(1e-13));
    CHECK(force_sums(m).x == 0);
    errors.push_back(std::abs(walls.net_force(m) / integral - 1));
  }
  INFO("errors " << errors[0] << ", " << errors[1] << ", " << errors[2]);
  CHECK(errors[2] < 3e-5);
  CHECK(std::log2(errors[0] / errors[2]) / 2 > 1.9);  // rest weights are chords: second order
}

TEST_CASE("the lower wall does what the upper wall does to the mirror image, to the last bit") {
  auto random = generator(63);
  Membranes m = biconcave_cells({{40, 9, 0.1}});
  deform(m, random, 1, 0.05);
  const int height = 64;
  for (double& y : m.position[1]) y = std::round(y * 1048576) / 1048576;  // so that height - 1 - y is exact
  Membranes mirrored = m;
  for (double& y : mirrored.position[1]) y = height - 1 - y;
  WallContacts<2> walls(m, {{0, morse(0.2, 0.75, 2.5, 18)}}, channel(height));
  run(walls, m), run(walls, mirrored);
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    REQUIRE(mirrored.force[1][i] == -m.force[1][i]);
    REQUIRE(m.force[0][i] == 0);
  }
  CHECK(walls.energy(mirrored) == walls.energy(m));
  CHECK(walls.energy(m) != 0);
}

TEST_CASE("walls act on cells of the named type alone, within each potential's own cutoff, and add up") {
  Membranes m = biconcave_cells({{40, 9, 0}, {100, 9, 0}, {160, 45, 0}});
  m.cells[1].type = 1;
  Membranes both = m, first = m, second = m;
  const WallInteraction far{0, morse(0.2, 0.3, 2.5, 18)}, near{0, repulsion(0.3, 4)};
  WallContacts<2> sum(m, {far, near}, channel(90)), a(m, {far}, channel(90)), b(m, {near}, channel(90));
  run(sum, both), run(a, first), run(b, second);
  int beyond = 0, touched = 0;
  for (int i = 0; i < m.node_count(); ++i) {
    REQUIRE(both.force[1][i] == Approx(first.force[1][i] + second.force[1][i]).margin(1e-15));
    const bool other_type = i >= m.cells[1].first, too_far = m.position[1][i] + 0.5 > 4;
    if (other_type || too_far) REQUIRE(second.force[1][i] == 0);
    if (other_type) REQUIRE(both.force[1][i] == 0);
    beyond += !other_type && too_far ? 1 : 0;
    touched += second.force[1][i] != 0 ? 1 : 0;
  }
  CHECK(beyond > 0);
  CHECK(touched > 0);
  CHECK(sum.energy(both) == Approx(a.energy(first) + b.energy(second)));
}

TEST_CASE("a potential is given the velocity at which a membrane leaves the wall it is near") {
  Membranes m = biconcave_cells({{40, 9, 0}, {100, 54, 0}});
  std::fill(m.velocity[0].begin(), m.velocity[0].end(), 0.5);
  std::fill(m.velocity[1].begin(), m.velocity[1].end(), 0.01);
  WallContacts<2> walls(m, {{0, damper(3, 8, "normal_velocity")}}, channel(64));
  run(walls, m);
  double size = 0;
  for (int i = 0; i < m.node_count(); ++i) {
    const bool near = m.position[1][i] + 0.5 <= 8 || 63.5 - m.position[1][i] <= 8;
    REQUIRE(m.force[1][i] ==
            Approx(near ? -3 * 0.01 * m.types[0]->rest_weight[i % 100] : 0));  // against the motion at both walls
    REQUIRE(m.force[0][i] == 0);
    size += std::abs(m.force[1][i]);
  }
  CHECK(size > 0.1);
}

TEST_CASE("without walls, and for what rubs, there are no contacts with walls") {
  Membranes m = biconcave_cells({{40, 9, 0}});
  const core::Potential good = morse(0.2, 0.75, 2.5, 18), rubs = damper(3, 8, "tangential_velocity");
  CHECK_THROWS_WITH(WallContacts<2>(m, {{0, good}}, periodic_box(200, 90)), Catch::Matchers::Contains("needs walls"));
  CHECK_THROWS_WITH(WallContacts<2>(m, {{0, rubs}}, channel(90)), Catch::Matchers::Contains("damper"));
}

TEST_CASE("bonds of a flat membrane with a wall form and pull as those with another membrane at the same distance") {
  const double gap = 3.5;
  const core::Potential bond = bridging_of_walls();
  Membranes before_wall = polygons({box(40, -0.5 + gap, 12)});
  Membranes before_other = polygons({box(40, 30, 12), box(40, 30 - gap - 12, 12)});
  WallContacts<2> wall(before_wall, {{0, bond}}, channel(90));
  Interactions<2> other(before_other, {{{0, 1}, bond}}, periodic_box(10000));
  for (int step = 0; step < 20; ++step) {
    for (auto* m : {&before_wall, &before_other}) std::fill(m->force[1].begin(), m->force[1].end(), 0.0);
    for (int phase = 0; phase < Interactions<2>::phases; ++phase) other.run({}, phase, before_other);
    run(wall, before_wall);
    for (int i = 1; i < 40; ++i) REQUIRE(before_wall.force[1][i] == Approx(before_other.force[1][i]).epsilon(1e-12));
  }
  CHECK(wall.energy(before_wall) == Approx(other.energy(before_other)).epsilon(1e-12));
  CHECK(wall.energy(before_wall) > 0.1);
  REQUIRE(before_wall.wall_contacts.of_cell[0].size() == 1);
  const double density = before_wall.wall_contacts.of_cell[0][0].value[20];
  CHECK(density > 0.05);
  CHECK(density == before_other.contacts.of_cell[0][0].value[20]);
  CHECK(wall.net_force(before_wall) == Approx(force_sums(before_wall).y).epsilon(1e-12));
  CHECK(before_wall.wall_contacts.of_cell[0][0].value[20] == density);  // a look is no step
}

TEST_CASE(
    "bonds with either wall are kept apart, are lost where a cell leaves the wall, and go on with another solver") {
  Membranes m = biconcave_cells({{40, 9.5, 0}, {100, 9.5, 0}});  // 19 high, 13.1 of which a cell fills
  m.cells[1].type = 1;
  const core::Domain<2> narrow = channel(20);
  WallContacts<2> walls(m, {{0, bridging_of_walls()}}, narrow);
  for (int step = 0; step < 3; ++step) run(walls, m);
  const std::vector<ContactState>& bonds = m.wall_contacts.of_cell[0];
  REQUIRE(bonds.size() == 2);
  CHECK(m.wall_contacts.of_cell[1].empty());
  CHECK(bonds[0].other == 0);
  CHECK(bonds[1].other == 1);
  for (int i = 0; i < m.cells[0].count; ++i) {
    REQUIRE((bonds[0].value[i] > 0) == (m.position[1][i] + 0.5 <= 8));
    REQUIRE((bonds[1].value[i] > 0) == (19.5 - m.position[1][i] <= 8));
  }
  const std::vector<double> upper = bonds[1].value;
  Membranes before = m;
  WallContacts<2> again(before, {{0, bridging_of_walls()}}, narrow);
  run(walls, m), run(again, before);
  CHECK(before.wall_contacts.of_cell[0][1].value == m.wall_contacts.of_cell[0][1].value);
  CHECK(m.wall_contacts.of_cell[0][1].value != upper);
  CHECK(m.wall_contacts.variables.size() == 1);

  for (int i = 0; i < m.cells[0].count; ++i) m.position[1][i] += 40;
  WallContacts<2> wide(m, {{0, bridging_of_walls()}}, channel(90));
  run(wide, m);
  CHECK(m.wall_contacts.of_cell[0].empty());
}

TEST_CASE("nodes on a wall, beyond it and nowhere give a force or none, but no NaN to others") {
  Membranes m = biconcave_cells({{40, 9, 0}});
  m.position[1][70] = -0.5, m.position[1][71] = -0.9, m.position[1][72] = std::nan(""),
  m.position[1][73] = std::numeric_limits<double>::infinity();
  WallContacts<2> walls(m, {{0, morse(0.2, 0.75, 2.5, 18)}}, channel(90));
  run(walls, m);
  for (const double force : m.force[1]) REQUIRE(std::isfinite(force));
  CHECK(m.force[1][70] > 0);
  CHECK(m.force[1][71] > 0);
  m.position[1][0] = std::nan("");  // where the search for the lowest node begins
  run(walls, m);
  CHECK(std::isfinite(m.force[1][70]));
}

TEST_CASE("forces of walls are the same to the last bit for one, two and five workers") {
  auto random = generator(64);
  Membranes start = biconcave_cells({{40, 9, 0.1}, {90, 12, -0.1}, {140, 49, 0.3}, {180, 30, 1.3}});
  deform(start, random, 1, 0.05);
  std::vector<Membranes> results;
  for (const int workers : {1, 2, 5}) {
    Membranes m = start;
    WallContacts<2> walls(m, {{0, morse(0.2, 0.3, 2.5, 18)}}, channel(64));
    run(walls, m, workers);
    results.push_back(m);
  }
  CHECK(results[1].force[1] == results[0].force[1]);
  CHECK(results[2].force[1] == results[0].force[1]);
  CHECK(force_sums(results[0]).size > 0.1);
}

TEST_CASE(
    "a polygon rolls along a wall: what it meets in narrow wells is far less than what corners of two cells meet") {
  // Of sides one spacing long and radius 5, at its closest all the while; over the strongest attraction.
  const auto hindrance = [](double width) {
    const double radius = 5, distance = 2.5;
    const int sides = 31;
    const auto at = [&](double gap, double turned) {
      return polygons({circle(radius, 40, -0.5 + gap + radius, sides, turned - std::numbers::pi / 2)});
    };
    Membranes m = at(distance, 0);
    WallContacts<2> walls(m, {{0, morse(1, 2 / width, distance, 60)}}, channel(90));
    double pull = 0;
    for (int k = 0; k <= 2000; ++k) pull = std::max(pull, -walls.net_force(at(distance + width * k / 400, 0)));
    std::vector<double> least;
    const double turn = 2 * std::numbers::pi / sides / 200;
    for (int j = 0; j <= 200; ++j) {
      double low = distance - 2 * width, high = distance;
      for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (walls.net_force(at(middle, j * turn)) > 0 ? low : high) = middle;
      }
      least.push_back(walls.energy(at(high, j * turn)));
    }
    double worst = 0;
    for (int j = 1; j < 200; ++j) worst = std::max(worst, std::abs(least[j + 1] - least[j - 1]) / (2 * turn * radius));
    return worst / pull;
  };
  CHECK(hindrance(0.5) == Approx(5.6e-5).epsilon(0.05));
  CHECK(hindrance(0.25) == Approx(0.0079).epsilon(0.02));
  CHECK(hindrance(0.17) == Approx(0.0356).epsilon(0.02));
}
