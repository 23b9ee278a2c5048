// Potentials within a closed surface: which parts may touch, gradients, balances, and shapes that must not feel them.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/surface/triangle_surface.hpp"
#include "surface_fixture.hpp"
#include "unit/fake_models.hpp"
#include "unit/random.hpp"
#include "unit/triangle_distance.hpp"

using namespace rouleau;
using namespace rouleau::core;
using rouleau::test::check_gradient;
using rouleau::test::distance_to_triangle;
using rouleau::test::run;

namespace {

const Domain<3> domain{{40, 40, 40}, {true, true, true}};

Surfaces of_shape(const core::TriangleSurface& mesh) {
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(mesh)));
  add_cell(s, 0, {20, 20, 20});
  return s;
}
Surfaces sphere(double radius, int n) { return of_shape(core::ellipsoid(n, Vec<3>::Constant(radius))); }

Interactions<3> within(Surfaces& s, double stiffness, double rest, double cutoff) {
  return {s, {}, domain, {{0, test::spring_potential(stiffness, rest, cutoff)}}};
}

Vec<3> force_on(const Surfaces& s, int i) { return {s.force[0][i], s.force[1][i], s.force[2][i]}; }
Vec<3> place_of(const Surfaces& s, int i) { return {s.position[0][i], s.position[1][i], s.position[2][i]}; }
double largest_force(const Surfaces& s) {
  double largest = 0;
  for (int i = 0; i < s.node_count(); ++i) largest = std::max(largest, force_on(s, i).norm());
  return largest;
}

}  // namespace

TEST_CASE(
    "a node of a sphere may touch the triangles that are half a circle of the cutoff's width away, and no others") {
  const double radius = 6, cutoff = GENERATE(2.0, 5.0, 9.0);
  const int n = GENERATE(6, 9);
  const Surfaces s = sphere(radius, n);
  const SelfReach reach(s.type_of(0), cutoff);
  const Nodes nodes = s.type_of(0).nodes();
  const auto arc = [&](int i, int j) {
    return radius * std::acos(std::clamp(nodes[i].dot(nodes[j]) / (nodes[i].norm() * nodes[j].norm()), -1.0, 1.0));
  };
  const double apart = std::numbers::pi / 2 * cutoff;
  long allowed = 0, not_allowed = 0;
  for (int node = 0; node < s.node_count(); ++node) {
    int triangle = 0;
    for (const auto& [i, j, k] : s.type_of(0).mesh.triangles()) {
      const double nearest = std::min({arc(node, i), arc(node, j), arc(node, k)});
      const bool may = reach.allows(node, triangle++);
      (may ? allowed : not_allowed) += 1;
      if (may) REQUIRE(nearest > 0.99 * apart);
      if (!may) REQUIRE(nearest < 1.06 * apart);  // chords are shorter than arcs
    }
  }
  CHECK(not_allowed > 0);
  CHECK((allowed > 0) == (cutoff < 2 * radius / 1.04));
}

TEST_CASE(
    "contacts within a surface are the closest of the triangles that may touch, while it moves and for any workers") {
  const unsigned seed = GENERATE(31u, 32u);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  Surfaces s = of_shape(core::biconcave_disc(8, 6));
  s.largest_step.assign(1, 0.0);
  const double cutoff = 2.5;
  TriangleContacts contacts(s, Cutoffs(1), domain, {cutoff}), shared(s, Cutoffs(1), domain, {cutoff});
  const SelfReach reach(s.type_of(0), cutoff);
  std::vector<TriangleContact> found, by_three;
  long touching = 0;
  for (int step = 0; step < 40; ++step) {
    contacts.measure({}, s);
    contacts.refresh({}, s);
    contacts.find(0, s, found);
    for (int worker = 0; worker < 3; ++worker) shared.measure({worker, 3}, s);
    for (int worker = 0; worker < 3; ++worker) shared.refresh({worker, 3}, s);
    shared.find(0, s, by_three);
    REQUIRE(found.size() == by_three.size());
    std::size_t next = 0;
    for (int node = 0; node < s.node_count(); ++node) {
      double nearest = cutoff;
      int triangle = 0;
      const Nodes nodes = s.nodes(0);
      for (const auto& [i, j, k] : s.type_of(0).mesh.triangles()) {
        if (!reach.allows(node, triangle++)) continue;
        nearest = std::min(nearest, distance_to_triangle(place_of(s, node), nodes[i], nodes[j], nodes[k]));
      }
      if (nearest >= cutoff) continue;
      REQUIRE(next < found.size());
      REQUIRE(found[next].node == node);
      REQUIRE(found[next].other == 0);
      REQUIRE(found[next].distance == Approx(nearest).epsilon(1e-12));
      REQUIRE(by_three[next].distance == found[next].distance);
      ++next;
    }
    REQUIRE(next == found.size());
    touching += static_cast<long>(next);
    // The faces come nearer to each other, with some noise.
    double most = 0;
    for (int i = 0; i < s.node_count(); ++i) {
      const Vec<3> move(0.01 * any(random), -0.006 * (s.position[1][i] - 20) + 0.01 * any(random), 0.01 * any(random));
      s.position[0][i] += move.x(), s.position[1][i] += move.y(), s.position[2][i] += move.z();
      most = std::max(most, move.norm());
    }
    s.largest_step[0] = most;
  }
  CHECK(touching > 1000);
  CHECK(contacts.renewals() < 20);
}

TEST_CASE(
    "forces within a surface are minus the gradient of their energy, without net force or torque, for any workers") {
  std::mt19937 random(22);
  std::uniform_real_distribution<double> any(-1, 1);
  Surfaces s = of_shape(core::biconcave_disc(6, 5));
  for (auto& places : s.position) {
    for (double& place : places) place += 0.05 * any(random);
  }
  Interactions<3> forces = within(s, 0.03, 1.5, 2.5);
  run(forces, s);
  const Surfaces at = s;
  const double largest = largest_force(s);
  REQUIRE(largest > 1e-3);
  Vec<3> force = Vec<3>::Zero(), torque = Vec<3>::Zero();
  for (int i = 0; i < s.node_count(); ++i) force += force_on(s, i), torque += place_of(s, i).cross(force_on(s, i));
  CHECK(force.norm() < 1e-12 * largest);
  CHECK(torque.norm() < 1e-12 * largest * 40);
  check_gradient(forces, s, largest, random);
  run(forces, s, 3);
  CHECK(s.force[0] == at.force[0]);
  CHECK(s.force[1] == at.force[1]);
  CHECK(s.force[2] == at.force[2]);
}

TEST_CASE("a sphere wider than the cutoff does nothing to itself, and one that was squeezed is pushed open") {
  Surfaces round = sphere(8, 8);
  Interactions<3> none = within(round, 0.1, 15, 15);
  run(none, round);
  CHECK(largest_force(round) == 0);
  CHECK(none.energy(round) == 0);
  Surfaces squeezed = sphere(8, 8);
  Interactions<3> some = within(squeezed, 0.1, 6, 6);
  for (double& z : squeezed.position[2]) z = 20 + 0.25 * (z - 20);  // 4 spacings thick in the middle
  run(some, squeezed);
  int pushed = 0;
  for (int i = 0; i < squeezed.node_count(); ++i) {
    const double height = squeezed.position[2][i] - 20;
    if (std::hypot(squeezed.position[0][i] - 20, squeezed.position[1][i] - 20) > 4 || std::abs(height) < 1) continue;
    REQUIRE(squeezed.force[2][i] * height > 0);
    ++pushed;
  }
  CHECK(pushed > 50);
}

TEST_CASE("faces that are nearly flat push each other by their area times the potential's force") {
  Surfaces s = sphere(8, 12);
  Interactions<3> forces = within(s, 0.1, 2, 2);
  for (double& z : s.position[2]) z = 20 + 0.05 * (z - 20);  // 0.8 spacings thick in the middle
  run(forces, s);
  const RestSurface& rest = s.type_of(0);
  double pushes = 0, springs = 0;
  for (int i = 0; i < s.node_count(); ++i) {
    const double height = s.position[2][i] - 20;
    if (std::hypot(s.position[0][i] - 20, s.position[1][i] - 20) > 4 || height < 0) continue;
    pushes += s.force[2][i];
    springs += rest.node_area[i] * 0.1 * (2 - 2 * height);
  }
  CHECK(pushes == Approx(springs).epsilon(0.02));
}

TEST_CASE("a potential within surfaces acts on its type alone, beside others between cells, which do not act within") {
  Surfaces s = of_shape(core::biconcave_disc(6, 5));
  s.types.push_back(s.types.front());
  add_cell(s, 1, {20, 24, 20});
  Surfaces within_alone = s, between_alone = s;
  const Potential spring = test::spring_potential(0.03, 1.5, 2.5);
  Interactions<3> both(s, {{{0, 1}, spring}}, domain, {{0, spring}});
  Interactions<3> own(within_alone, {}, domain, {{0, spring}}), other(between_alone, {{{0, 1}, spring}}, domain);
  run(both, s), run(own, within_alone), run(other, between_alone);
  const double largest = largest_force(s);
  REQUIRE(largest_force(within_alone) > 1e-3);
  REQUIRE(largest_force(between_alone) > 1e-3);
  for (int i = 0; i < s.node_count(); ++i) {
    REQUIRE((force_on(s, i) - force_on(within_alone, i) - force_on(between_alone, i)).norm() < 1e-14 * largest);
    if (i >= s.cells[1].first) REQUIRE(force_on(within_alone, i).norm() == 0);
  }
  CHECK(both.energy(s) == Approx(own.energy(within_alone) + other.energy(between_alone)).epsilon(1e-13));
}

TEST_CASE("what remembers or looks at velocities does not act within a surface") {
  Surfaces s = sphere(6, 5);
  const Potential damper = test::damper(0.1, 3, "normal_velocity");
  CHECK_THROWS_WITH(Interactions<3>(s, {}, domain, {{0, damper}}), Catch::Matchers::Contains("damper"));
}
