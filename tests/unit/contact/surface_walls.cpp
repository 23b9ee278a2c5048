// Walls that act on surfaces in three dimensions: the energy of a sphere in closed form, forces against its
// differences.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/contact/wall_contacts.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "core/surface/triangle_surface.hpp"
#include "unit/fake_models.hpp"

using namespace rouleau;
using namespace rouleau::core;

namespace {

constexpr double stiffness = 0.3, rest = 1.2, cutoff = 3;
const Domain<3> domain{{24, 20, 22}, {true, false, false}};

Surfaces sphere(int n, double radius, const Vec<3>& center) {
  Surfaces s;
  s.types.push_back(
      std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(n, Vec<3>::Constant(radius)))));
  add_cell(s, 0, center, Eigen::AngleAxisd(0.4, Vec<3>(3, 1, 2).normalized()).toRotationMatrix());
  return s;
}
WallContacts<3> walls(Surfaces& s) { return {s, {{0, test::spring_potential(stiffness, rest, cutoff)}}, domain}; }
double energy(Surfaces s) { return walls(s).energy(s); }

void act(WallContacts<3>& contacts, Surfaces& s, int workers = 1) {
  for (auto& force : s.force) std::fill(force.begin(), force.end(), 0.0);
  for (int worker = 0; worker < workers; ++worker) contacts.run({worker, workers}, s);
}

}  // namespace

TEST_CASE("a sphere beside a wall has the energy of the zones of its surface") {
  // A zone of a sphere has the area 2 pi R dr, wherever it lies.
  constexpr double radius = 5, gap = 0.7, there = cutoff - rest, here = gap - rest;
  constexpr double integral =
      stiffness / 2 * ((there * there * there - here * here * here) / 3 - there * there * (cutoff - gap));
  const double exact = 2 * std::numbers::pi * radius * integral;
  for (const Vec<3>& center : {Vec<3>(3, -0.5 + gap + radius, 10), Vec<3>(3, 19.5 - gap - radius, 10),
                               Vec<3>(3, 9, -0.5 + gap + radius), Vec<3>(3, 9, 21.5 - gap - radius)}) {
    std::vector<double> errors;
    for (const int n : {8, 16}) errors.push_back(std::abs(energy(sphere(n, radius, center)) / exact - 1));
    CHECK(errors[1] < 0.01);
    CHECK(errors[1] < errors[0] / 2.5);
  }
  CHECK(energy(sphere(8, radius, {3, 9, 10})) == 0);
}

TEST_CASE("the wall of a tube acts along its radius") {
  // A sphere around the axis has, at the distance s from its equator's plane, the gap R - sqrt(a^2 - s^2).
  constexpr double radius = 8, of_sphere = 7;
  double exact = 0;
  constexpr int zones = 4000;
  for (int i = 0; i < zones; ++i) {
    const double s = of_sphere * ((i + 0.5) / zones * 2 - 1), r = radius - std::sqrt(of_sphere * of_sphere - s * s);
    const double there = cutoff - rest, here = r - rest;
    if (r < cutoff)
      exact += stiffness / 2 * (here * here - there * there) * 2 * std::numbers::pi * of_sphere * 2 * of_sphere / zones;
  }
  Surfaces s = sphere(16, of_sphere, {3, 9.5, 10.5});
  WallContacts<3> tube(s, {{0, test::spring_potential(stiffness, rest, cutoff)}}, domain,
                       tube_region(domain.size, radius));
  CHECK(tube.energy(s) == Approx(exact).epsilon(0.01));
  for (double& y : s.position[1]) y += 0.7;
  act(tube, s);
  const Surfaces at = s;
  constexpr double h = 1e-5;
  for (int i = 0; i < s.node_count(); i += 29) {
    CHECK(s.force[0][i] == 0);
    for (const auto& [places, found] : {std::pair(&s.position[1], &at.force[1]), {&s.position[2], &at.force[2]}}) {
      const double here = (*places)[i];
      (*places)[i] = here + h;
      const double above = tube.energy(s);
      (*places)[i] = here - h;
      const double below = tube.energy(s);
      (*places)[i] = here;
      CHECK(std::abs((below - above) / (2 * h) - (*found)[i]) < 1e-7);
    }
  }
  CHECK(tube.net_force(s) < 0);
}

TEST_CASE("forces of walls on surfaces are minus the gradient of their energy, whatever the number of workers") {
  Surfaces s = sphere(6, 4, {3, 4.3, 17.1});  // in a corner
  WallContacts<3> contacts = walls(s);
  act(contacts, s);
  const Surfaces at = s;
  double largest = 0, along_y = 0;
  for (int i = 0; i < s.node_count(); ++i) {
    largest = std::max({largest, std::abs(s.force[1][i]), std::abs(s.force[2][i])});
    along_y += s.force[1][i];
    CHECK(s.force[0][i] == 0);
  }
  REQUIRE(largest > 1e-3);
  CHECK(contacts.net_force(s) == Approx(along_y));
  constexpr double h = 1e-5;
  for (int i = 0; i < s.node_count(); i += 3) {
    for (const auto& [places, found] : {std::pair(&s.position[1], &at.force[1]), {&s.position[2], &at.force[2]}}) {
      const double here = (*places)[i];
      (*places)[i] = here + h;
      const double above = contacts.energy(s);
      (*places)[i] = here - h;
      const double below = contacts.energy(s);
      (*places)[i] = here;
      CHECK(std::abs((below - above) / (2 * h) - (*found)[i]) < 1e-7 * largest);
    }
  }
  act(contacts, s, 2);
  CHECK(s.force[1] == at.force[1]);
  CHECK(s.force[2] == at.force[2]);
}

TEST_CASE("walls act on surfaces where there are walls, and do not rub") {
  Surfaces s = sphere(4, 3, {4, 4, 4});
  CHECK_THROWS_AS(WallContacts<3>(s, {{0, test::spring_potential(1, 1, 2)}}, Domain<3>{{8, 8, 8}, {true, true, true}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(WallContacts<3>(s, {{0, test::damper(3, 2, "tangential_velocity")}}, domain), std::invalid_argument);
}

TEST_CASE("a potential is given the velocity at which a surface leaves the wall that it is near") {
  Surfaces s = sphere(6, 4, {3, 4.3, 17.1});  // in a corner, above y = -0.5 and below z = 21.5
  std::fill(s.velocity[0].begin(), s.velocity[0].end(), 0.5);
  std::fill(s.velocity[1].begin(), s.velocity[1].end(), 0.01);
  std::fill(s.velocity[2].begin(), s.velocity[2].end(), 0.02);
  WallContacts<3> contacts(s, {{0, test::damper(3, 2, "normal_velocity")}}, domain);
  act(contacts, s);
  const std::vector<double>& area = s.type_of(0).node_area;
  double size_y = 0, size_z = 0;
  for (int i = 0; i < s.node_count(); ++i) {
    CHECK(s.force[0][i] == 0);
    CHECK(s.force[1][i] == Approx(s.position[1][i] + 0.5 <= 2 ? -3 * 0.01 * area[i] : 0));  // against the motion
    CHECK(s.force[2][i] == Approx(21.5 - s.position[2][i] <= 2 ? -3 * 0.02 * area[i] : 0));
    size_y += std::abs(s.force[1][i]), size_z += std::abs(s.force[2][i]);
  }
  CHECK(size_y > 0.1);
  CHECK(size_z > 0.1);
}
