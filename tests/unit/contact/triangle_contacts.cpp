// Contacts of surfaces in three dimensions: closest points against all triangles, forces against differences of the
// energy, balances, and the energy of parallel plates.
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
using rouleau::test::closest_on_triangle;
using rouleau::test::distance_to_triangle;
using rouleau::test::run;

namespace {

constexpr std::array<int, 3> box = {24, 20, 22};
const Domain<3> domain{box, {true, false, true}};

/// A sphere and a disc that nearly touch, and their images across the borders along x and z.
Surfaces pair(std::mt19937& random, double apart = 1.2) {
  std::uniform_real_distribution<double> any(-1, 1);
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(5, {3, 3, 3}))));
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::biconcave_disc(6, 4))));
  const Vec<3> center(any(random), 10, any(random) + 21),
      towards = Vec<3>(any(random), any(random), any(random)).normalized();
  add_cell(s, 0, center);
  add_cell(s, 1, center + (4.2 + apart) * towards, Eigen::Quaterniond::UnitRandom().toRotationMatrix());
  for (auto& places : s.position) {
    for (double& place : places) place += 0.05 * any(random);
  }
  return s;
}

/// Over all triangles of another cell's image, one by one, but those with a corner so far away that all of the triangle
/// is farther than the cutoff: no edge here is 2 long.
double distance_to(const Surfaces& s, const Vec<3>& place, int other, const std::array<int, 3>& shift, double cutoff) {
  Vec<3> moved = place;
  for (int k = 0; k < 3; ++k) moved[k] -= shift[k] * box[k];
  double nearest = 1e300;
  const Nodes nodes = s.nodes(other);
  for (const auto& [i, j, k] : s.type_of(other).mesh.triangles()) {
    const double x = moved.x() - nodes.x[i], y = moved.y() - nodes.y[i], z = moved.z() - nodes.z[i];
    if (x * x + y * y + z * z > (cutoff + 2) * (cutoff + 2)) continue;
    nearest = std::min(nearest, distance_to_triangle(moved, nodes[i], nodes[j], nodes[k]));
  }
  return nearest;
}

}  // namespace

TEST_CASE("the closest point of a triangle is not farther than any other of its points") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  int in_face = 0, on_edge = 0, in_corner = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto point = [&] { return Vec<3>(any(random), any(random), any(random)); };
    const Vec<3> a = point(), b = point(), c = point(), p = 2 * point();
    const auto [weight, place] = closest_on_triangle(p, a, b, c);
    CHECK((weight[0] * a + weight[1] * b + weight[2] * c - place).norm() < 1e-12);
    CHECK(weight[0] + weight[1] + weight[2] == Approx(1));
    const double distance = (p - place).norm();
    for (int i = 0; i <= 12; ++i) {
      for (int j = 0; i + j <= 12; ++j) {
        const Vec<3> other = (i * a + j * b + (12 - i - j) * c) / 12.0;
        REQUIRE(distance <= (p - other).norm() + 1e-12);
      }
    }
    int zeros = 0;
    for (const double w : weight) {
      REQUIRE(w >= 0);
      zeros += w == 0 ? 1 : 0;
    }
    (zeros == 0 ? in_face : zeros == 1 ? on_edge : in_corner) += 1;
  }
  CHECK(in_face > 50);
  CHECK(on_edge > 100);
  CHECK(in_corner > 100);
}

TEST_CASE("contacts of surfaces are the closest of all triangles, while cells move and for any workers") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  constexpr double cutoff = 2.5;
  int found = 0;
  long renewals = 0;
  for (int trial = 0; trial < 3; ++trial) {
    Surfaces s = pair(random);
    Cutoffs cutoffs(2);
    for (int a = 0; a < 2; ++a) cutoffs.raise(a, 1 - a, cutoff), cutoffs.raise(a, a, cutoff);
    TriangleContacts contacts(s, cutoffs, domain);
    s.largest_step.assign(2, 0.0);
    for (int step = 0; step < 16; ++step) {
      const int workers = 1 + step % 2;
      for (int w = 0; w < workers; ++w) contacts.measure({w, workers}, s);
      std::vector<TriangleContact> lists[2];
      for (int w = 0; w < workers; ++w) {  // one may find contacts before another has made its lists
        contacts.refresh({w, workers}, s);
        const Range cells = Worker{w, workers}.share(2);
        for (int cell = cells.begin; cell < cells.end; ++cell) contacts.find(cell, s, lists[cell]);
      }
      for (int cell = 0; cell < 2; ++cell) {
        const std::vector<TriangleContact>& list = lists[cell];
        std::size_t next = 0;
        for (int node = s.cells[cell].first; node < s.cells[cell].end(); ++node) {
          const Vec<3> place(s.position[0][node], s.position[1][node], s.position[2][node]);
          for (int other = 0; other < 2; ++other) {
            for (int x = -1; x <= 1; ++x) {
              for (int z = -2; z <= 1; ++z) {
                const std::array<int, 3> shift{x, 0, z};
                if (other == cell && x == 0 && z == 0) continue;
                const double distance = distance_to(s, place, other, shift, cutoff);
                if (distance > cutoff) continue;
                REQUIRE(next < list.size());
                REQUIRE(list[next].node == node);
                REQUIRE(list[next].other == other);
                REQUIRE(list[next].shift == ImageShift{x, 0, z});
                REQUIRE(list[next].distance == Approx(distance).epsilon(1e-12).margin(1e-14));  // rounding of positions
                ++next, ++found;
              }
            }
          }
        }
        REQUIRE(next == list.size());
      }
      const Vec<3> way = 0.05 * Vec<3>(any(random), any(random), any(random));
      for (int i = s.cells[1].first; i < s.cells[1].end(); ++i)
        s.position[0][i] += way.x(), s.position[1][i] += way.y(), s.position[2][i] += way.z();
      s.largest_step[1] = way.norm() * (1 + 1e-12);
    }
    renewals += contacts.renewals();
  }
  CHECK(found > 1000);
  CHECK(renewals < 36);
}

TEST_CASE("in a box narrower than the cutoff all images of a surface count") {
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(3, {1.5, 1.5, 1.5}))));
  add_cell(s, 0, {10, 12, 3});
  add_cell(s, 0, {14, 12, 4});
  const Domain<3> narrow{{24, 24, 8}, {true, true, true}};
  for (const double cutoff : {2.5, 4.5, 6.0, 9.0}) {
    Cutoffs cutoffs(1);
    cutoffs.raise(0, 0, cutoff);
    TriangleContacts contacts(s, cutoffs, narrow);
    contacts.measure({}, s);
    contacts.refresh({}, s);
    std::size_t expected = 0, found = 0;
    std::vector<TriangleContact> list;
    for (int cell = 0; cell < 2; ++cell) {
      contacts.find(cell, s, list);
      found += list.size();
      for (int node = s.cells[cell].first; node < s.cells[cell].end(); ++node) {
        for (int other = 0; other < 2; ++other) {
          for (int z = -3; z <= 3; ++z) {
            if (other == cell && z == 0) continue;
            const Vec<3> moved(s.position[0][node], s.position[1][node], s.position[2][node] - 8 * z);
            const Nodes nodes = s.nodes(other);
            double nearest = 1e300;
            for (const auto& [i, j, k] : s.type_of(other).mesh.triangles())
              nearest = std::min(nearest, distance_to_triangle(moved, nodes[i], nodes[j], nodes[k]));
            expected += nearest <= cutoff ? 1 : 0;
          }
        }
      }
    }
    CHECK(found == expected);
    CHECK(expected > 50);
  }
}

TEST_CASE(
    "forces between surfaces are minus the gradient of their energy, balanced, with the same bits for any workers") {
  std::mt19937 random(21);
  for (int trial = 0; trial < 4; ++trial) {
    Surfaces s = pair(random, 0.6);
    const Interaction interaction{{0, 1}, test::spring_potential(0.03, 1.5, 3)};
    Interactions<3> forces(s, {interaction}, domain);
    run(forces, s);
    const Surfaces at = s;
    double largest = 0, net[3] = {0, 0, 0};
    for (int i = 0; i < s.node_count(); ++i) {
      largest = std::max({largest, std::abs(s.force[0][i]), std::abs(s.force[1][i]), std::abs(s.force[2][i])});
      net[0] += s.force[0][i], net[1] += s.force[1][i], net[2] += s.force[2][i];
    }
    REQUIRE(largest > 1e-4);
    for (const double sum : net) CHECK(std::abs(sum) < 1e-12 * largest);
    check_gradient(forces, s, largest, random);
    run(forces, s, 3);
    Interactions<3> fresh(s, {interaction}, domain);
    Surfaces again = s;
    run(fresh, again, 2);
    CHECK(s.force[0] == again.force[0]);
    CHECK(s.force[1] == again.force[1]);
    CHECK(s.force[2] == again.force[2]);
  }
}

TEST_CASE("two bodies that attract each other feel neither a net force nor a torque") {
  std::mt19937 random(4);
  const Domain<3> open{{60, 60, 60}, {true, true, true}};
  Surfaces s = pair(random, 0.4);
  for (double& x : s.position[0]) x += 30;
  for (double& y : s.position[1]) y += 20;
  Interactions<3> forces(s, {{{0, 1}, test::spring_potential(0.03, 1.5, 3)}}, open);
  run(forces, s);
  Vec<3> force = Vec<3>::Zero(), torque = Vec<3>::Zero();
  double largest = 0;
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> f(s.force[0][i], s.force[1][i], s.force[2][i]),
        place(s.position[0][i], s.position[1][i], s.position[2][i]);
    force += f, torque += place.cross(f);
    largest = std::max(largest, f.norm());
  }
  REQUIRE(largest > 0);
  CHECK(force.norm() < 1e-12 * largest);
  CHECK(torque.norm() < 1e-12 * largest * 60);
}

TEST_CASE("spheres around the same centre have the energy of their areas at the gap between them") {
  // Radii 6 and 7.5, nodes facing triangles: the gap is that of polyhedra, of second order in their edges.
  std::vector<double> errors;
  for (const int n : {8, 16}) {
    Surfaces s;
    for (const double radius : {6.0, 7.5})
      s.types.push_back(
          std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(n, Vec<3>::Constant(radius)))));
    add_cell(s, 0, {12, 10, 11});
    add_cell(s, 1, {12, 10, 11}, Eigen::AngleAxisd(0.3, Vec<3>(1, 2, 3).normalized()).toRotationMatrix());
    Interactions<3> forces(s, {{{0, 1}, test::spring_potential(0.5, 1.0, 4)}},
                           Domain<3>{{24, 24, 24}, {true, true, true}});
    run(forces, s);
    const double exact = 0.25 * (0.5 * 0.5 - 3 * 3) * 4 * std::numbers::pi * (36 + 7.5 * 7.5) / 2;
    errors.push_back(std::abs(forces.energy(s) / exact - 1));
  }
  CHECK(errors[1] < 0.03);
  CHECK(errors[0] / errors[1] > 3);
}
