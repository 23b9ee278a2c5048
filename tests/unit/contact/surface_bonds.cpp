// Interactions that remember and that want velocities, in three dimensions: bonds form, break, stay with their nodes,
// and balance, between cells, images and walls.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/contact/interactions.hpp"
#include "core/contact/wall_contacts.hpp"
#include "core/surface/triangle_surface.hpp"
#include "unit/cell_fixture.hpp"
#include "unit/fake_models.hpp"

using namespace rouleau;
using namespace rouleau::core;

namespace {

constexpr double sites = 0.7, stiffness = 0.3, bond_length = 1.1, on = 0.02, off = 0.03, forward_share = 0.4,
                 thermal = 0.9, cutoff = 3;
const Domain<3> domain{{24, 20, 20}, {true, false, true}};

core::Potential bridging(double on_rate = on, double off_rate = off, double end = cutoff) {
  return test::potential("bridging", {sites, stiffness, bond_length, on_rate, off_rate, forward_share, thermal, end});
}

/// Bonds of one area after so many steps at a distance: the solution of Dembo's rate equation.
double bonds_after(int steps, double distance) {
  const double energy = stiffness / 2 * (distance - bond_length) * (distance - bond_length) / thermal;
  const double forming = on * std::exp(-forward_share * energy),
               rate = forming + off * std::exp((1 - forward_share) * energy);
  return sites * forming / rate * (1 - std::exp(-steps * rate));
}

/// Spheres of radius 4.
Surfaces spheres(const std::vector<Vec<3>>& centers) {
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(6, {4, 4, 4}))));
  double angle = 0.3;
  for (const Vec<3>& center : centers) {
    add_cell(s, 0, center, Eigen::AngleAxisd(angle, Vec<3>(3, 1, 2).normalized()).toRotationMatrix());
    angle += 0.5;
  }
  return s;
}
/// The second one near the first, and near its image across z.
Surfaces neighbours() { return spheres({{8, 9.5, 3}, {8.5, 9.1, 12.4}}); }

void clear_forces(Surfaces& s) {
  for (auto& force : s.force) std::fill(force.begin(), force.end(), 0.0);
}
void run(Interactions<3>& forces, Surfaces& s, int workers = 1) {
  clear_forces(s);
  for (int phase = 0; phase < 3; ++phase) {
    for (int worker = 0; worker < workers; ++worker) forces.run({worker, workers}, phase, s);
  }
}

/// The value of a variable at a node; less than nothing where there is none.
double value_at(const std::vector<ContactState>& states, int node, int other, const ImageShift& shift) {
  for (const ContactState& state : states) {
    if (state.other == other && state.shift == shift) return state.value[node];
  }
  return -1;
}

void move(Surfaces& s, int cell, const Vec<3>& by) {
  for (int i = s.cells[cell].first; i < s.cells[cell].end(); ++i)
    s.position[0][i] += by.x(), s.position[1][i] += by.y(), s.position[2][i] += by.z();
}

/// Gives nodes bonds that vanish towards the cutoff.
void set_bonds(const Interactions<3>& forces, Surfaces& s) {
  for (int cell = 0; cell < s.cell_count(); ++cell) {
    std::vector<TriangleContact> contacts;
    forces.contacts().find(cell, s, contacts);
    for (ContactState& state : s.contacts.of_cell[cell]) {
      for (const TriangleContact& contact : contacts) {
        const int node = contact.node - s.cells[cell].first;
        if (contact.other == state.other && state.shift == contact.shift)
          state.value[node] = contact.distance < cutoff - 0.5 ? 0.5 + 0.01 * node : 0;
      }
    }
  }
}

}  // namespace

TEST_CASE("bonds between surfaces at a fixed distance follow the solution of their rate equation") {
  Surfaces s = neighbours();
  Interactions<3> forces(s, {{{0, 0}, bridging()}}, domain);
  int done = 0;
  for (const int steps : {1, 9, 40, 2000}) {
    for (; done < steps; ++done) run(forces, s);
    for (const int cell : {0, 1}) {
      std::vector<TriangleContact> contacts;
      forces.contacts().find(cell, s, contacts);
      std::set<int> images;
      for (const TriangleContact& contact : contacts) {
        images.insert(contact.shift.z);
        REQUIRE(value_at(s.contacts.of_cell[cell], contact.node - s.cells[cell].first, contact.other, contact.shift) ==
                Approx(bonds_after(steps, contact.distance)).epsilon(1e-11));
      }
      REQUIRE(contacts.size() > 40);
      REQUIRE(images == (cell == 0 ? std::set{-1, 0} : std::set{0, 1}));
    }
  }
}

TEST_CASE("bonds of surfaces stay with a node while the other one slides past, and are lost beyond the cutoff") {
  Surfaces s = neighbours();
  Interactions<3> forces(s, {{{0, 0}, bridging(0, 1e-300)}}, domain);  // nothing forms or breaks
  run(forces, s);
  set_bonds(forces, s);
  const std::vector<ContactState> before = s.contacts.of_cell[0];
  REQUIRE(before.size() == 2);
  for (int step = 0; step < 30; ++step) {
    move(s, 1, {0.03, 0.01, 0});
    run(forces, s);
  }
  std::vector<TriangleContact> contacts;
  forces.contacts().find(0, s, contacts);
  int kept = 0;
  for (const TriangleContact& contact : contacts) {
    const double was = value_at(before, contact.node, contact.other, contact.shift);
    if (was <= 0 || contact.distance > cutoff - 1) continue;
    CHECK(value_at(s.contacts.of_cell[0], contact.node, contact.other, contact.shift) == was);
    ++kept;
  }
  CHECK(kept > 10);
  move(s, 1, {12, 0, 0});
  run(forces, s);
  CHECK(s.contacts.of_cell[0].empty());
  move(s, 1, {-12, 0, 0});
  run(forces, s);
  REQUIRE(s.contacts.of_cell[0].size() == 2);
  for (const ContactState& state : s.contacts.of_cell[0])
    CHECK(std::all_of(state.value.begin(), state.value.end(), [](double bonds) { return bonds == 0; }));
}

TEST_CASE("forces of bonds between surfaces are minus the gradient of their energy, and balance, while none changes") {
  Surfaces s = neighbours();
  Interactions<3> forces(s, {{{0, 0}, bridging(0, 1e-300)}}, domain);
  run(forces, s);
  set_bonds(forces, s);
  const ContactMemory bonds = s.contacts;
  run(forces, s);
  CHECK(forces.energy(s) > 0);
  const Surfaces at = s;
  double largest = 0;
  Vec<3> net = Vec<3>::Zero();
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> force(s.force[0][i], s.force[1][i], s.force[2][i]);
    largest = std::max(largest, force.norm());
    net += force;
  }
  REQUIRE(largest > 1e-2);
  CHECK(net.norm() < 1e-12 * largest);
  constexpr double h = 1e-5;
  auto& places = s.position;
  const auto& found = at.force;
  for (int i = 0; i < s.node_count(); i += 7) {
    for (int k = 0; k < 3; ++k) {
      const double here = places[k][i];
      double energy[2];
      for (const int side : {0, 1}) {
        places[k][i] = here + (side == 0 ? -h : h);
        s.contacts = bonds;  // whoever crosses the cutoff has none, and gets them back
        run(forces, s);
        energy[side] = forces.energy(s);
      }
      places[k][i] = here;
      CHECK(std::abs((energy[0] - energy[1]) / (2 * h) - found[k][i]) < 1e-7 * largest);
    }
  }
}

TEST_CASE("bonds of surfaces add to other potentials, and looking at them changes none") {
  Surfaces both = neighbours(), one = both, other = both;
  const core::Potential spring = test::spring_potential(0.03, 1.5, 2);
  Interactions<3> together(both, {{{0, 0}, spring}, {{0, 0}, bridging()}}, domain),
      first(one, {{{0, 0}, spring}}, domain), second(other, {{{0, 0}, bridging()}}, domain);
  for (int step = 0; step < 5; ++step) {
    run(together, both, 3), run(first, one), run(second, other, 2);
    for (int look = 0; look < 3; ++look) (void)together.energy(both);
  }
  CHECK(one.contacts.of_cell.empty());
  double size = 0;
  for (int i = 0; i < both.node_count(); ++i) {
    REQUIRE(both.force[2][i] == Approx(one.force[2][i] + other.force[2][i]).margin(1e-14));
    size += std::abs(other.force[2][i]);
  }
  CHECK(size > 1e-3);
  CHECK(together.energy(both) == Approx(first.energy(one) + second.energy(other)));
  for (std::size_t cell = 0; cell < 2; ++cell) {
    const auto &found = both.contacts.of_cell[cell], &expected = other.contacts.of_cell[cell];
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) CHECK(found[k].value == expected[k].value);
  }
}

TEST_CASE("each wall has bonds of its own with a surface") {
  const Domain<3> channel{{24, 20, 22}, {true, false, false}};
  Surfaces s = spheres({{8, 5.0, 16.0}});  // its lowest point at y = 1, its farthest at z = 20: 1.5 from both walls
  WallContacts<3> walls(s, {{0, bridging()}}, channel);
  for (int step = 0; step < 60; ++step) clear_forces(s), walls.run({}, s);
  REQUIRE(s.wall_contacts.of_cell[0].size() == 2);
  int seen = 0;
  for (int i = 0; i < s.node_count(); ++i) {
    for (const auto& [wall, distance] : {std::pair(0, s.position[1][i] + 0.5), std::pair(3, 21.5 - s.position[2][i])}) {
      if (distance > cutoff) continue;
      CHECK(value_at(s.wall_contacts.of_cell[0], i, wall, {}) == Approx(bonds_after(60, distance)).epsilon(1e-11));
      ++seen;
    }
  }
  CHECK(seen > 20);
  move(s, 0, {0, 4, 0});
  walls.run({}, s);
  REQUIRE(s.wall_contacts.of_cell[0].size() == 1);
  CHECK(s.wall_contacts.of_cell[0].front().other == 3);
}

TEST_CASE("surfaces that slide against each other see the part of the velocity that is not along the distance") {
  Surfaces s = neighbours();
  const Vec<3> motion(0.3, -0.2, 0.5);  // of the second cell; the first rests
  for (int i = s.cells[1].first; i < s.node_count(); ++i)
    s.velocity[0][i] = motion.x(), s.velocity[1][i] = motion.y(), s.velocity[2][i] = motion.z();
  Interactions<3> forces(s, {{{0, 0}, test::rubbing(2, cutoff)}}, domain);
  CHECK(forces.needs_velocities());
  run(forces, s);
  const TriangleContacts all = TriangleContacts::within(cutoff, s, domain);
  Vec<3> on_first = Vec<3>::Zero(), expected = Vec<3>::Zero();
  for (int i = 0; i < s.cells[1].first; ++i) on_first += Vec<3>(s.force[0][i], s.force[1][i], s.force[2][i]);
  double slowest = 1, fastest = 0;
  for (const int cell : {0, 1}) {
    std::vector<TriangleContact> found;
    all.find(cell, s, found);
    for (const TriangleContact& contact : found) {
      if (contact.distance > cutoff) continue;
      const Vec<3> across = motion.cross(contact.direction);  // as long as what is not along the distance
      const double area = s.type_of(0).node_area[contact.node - s.cells[cell].first];
      expected += (cell == 0 ? 1 : -1) * area / 2 * 2 * across.norm() * contact.direction;
      slowest = std::min(slowest, across.norm()), fastest = std::max(fastest, across.norm());
    }
  }
  CHECK(fastest > 1.05 * slowest);
  REQUIRE(expected.norm() > 1);
  CHECK((on_first - expected).norm() < 1e-12 * expected.norm());
  const Domain<3> channel{{24, 20, 22}, {true, false, false}};
  CHECK_THROWS_AS(WallContacts<3>(s, {{0, test::rubbing(2, cutoff)}}, channel), std::invalid_argument);
}

TEST_CASE("the normal velocity at a contact of surfaces is the rate at which the distance changes") {
  Surfaces s = neighbours();
  auto random = test::generator(71);
  std::uniform_real_distribution<double> any(-1, 1);
  for (auto& velocity : s.velocity)
    for (double& v : velocity) v = any(random);
  Interactions<3> forces(s, {{{0, 0}, test::damper(2, cutoff, "normal_velocity")}}, domain);
  CHECK(forces.needs_velocities());
  run(forces, s);
  // What is taken out of the motion is the sum over all contacts of A/2 c (d distance / dt)^2.
  double power = 0, expected = 0, net = 0, size = 0;
  for (int i = 0; i < s.node_count(); ++i) {
    power -= s.force[0][i] * s.velocity[0][i] + s.force[1][i] * s.velocity[1][i] + s.force[2][i] * s.velocity[2][i];
    net += s.force[1][i], size += std::abs(s.force[1][i]);
  }
  const auto contacts_at = [&](double time) {
    Surfaces moved = s;
    for (int i = 0; i < s.node_count(); ++i) {
      moved.position[0][i] += time * s.velocity[0][i], moved.position[1][i] += time * s.velocity[1][i],
          moved.position[2][i] += time * s.velocity[2][i];
    }
    const TriangleContacts all = TriangleContacts::within(cutoff + 0.1, moved, domain);
    std::vector<TriangleContact> found[2];
    for (const int cell : {0, 1}) all.find(cell, moved, found[cell]);
    return std::pair(found[0], found[1]);
  };
  constexpr double h = 1e-5;
  const auto before = contacts_at(-h), now = contacts_at(0), after = contacts_at(h);
  for (const auto& [here, earlier, later] :
       {std::tuple(now.first, before.first, after.first), {now.second, before.second, after.second}}) {
    const auto same = [](const TriangleContact& a, const TriangleContact& b) {
      return a.node == b.node && a.other == b.other && a.shift == b.shift;
    };
    for (const TriangleContact& contact : here) {
      if (contact.distance > cutoff) continue;
      const auto in = [&](const std::vector<TriangleContact>& list) {
        return std::find_if(list.begin(), list.end(), [&](const auto& c) { return same(c, contact); })->distance;
      };
      const double rate = (in(later)-in(earlier)) / (2 * h);
      const int cell = contact.node < s.cells[1].first ? 0 : 1;
      expected += s.type_of(0).node_area[contact.node - s.cells[cell].first] / 2 * 2 * rate * rate;
    }
  }
  REQUIRE(expected > 1);
  CHECK(power == Approx(expected).epsilon(1e-6));
  CHECK(std::abs(net) < 1e-12 * size);
  CHECK_THROWS_AS(Interactions<3>(s, {{{0, 0}, test::damper(2, cutoff, "tangential_velocity")}}, domain),
                  std::invalid_argument);
}
