// The slip correction of surfaces: conservation, adjointness, energy.
#include "core/coupling/surface_slip.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "shape/surface.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// An uneven sphere of radius 5 and 162 nodes, whose forces and velocities are random.
Surfaces uneven_sphere(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(shape::rest_surface(shape::ellipsoid(4, {5, 5, 5}))));
  add_cell(s, 0, {9, 8, 7});
  for (auto* values : {&s.x, &s.y, &s.z}) {
    for (double& value : *values) value += 0.1 * any(random);
  }
  for (auto* values : {&s.force_x, &s.force_y, &s.force_z, &s.velocity_x, &s.velocity_y, &s.velocity_z}) {
    for (double& value : *values) value = any(random);
  }
  return s;
}

SurfaceSlip slip_of(const Surfaces& s, SlipConstants constants, double stiffness = 0) {
  SurfaceSlip slip(s, {{constants, stiffness}}, 1.0 / 6);
  slip.measure({}, s);
  slip.complete({}, s);
  return slip;
}

Vec<3> vector(const std::array<const double*, 3>& of, int i) { return {of[0][i], of[1][i], of[2][i]}; }

}  // namespace

TEST_CASE("the slip correction of surfaces adds neither force nor torque to the fluid") {
  auto random = generator(83);
  const double ratio = GENERATE(1.0, 5.0, 0.2);
  const Surfaces s = uneven_sphere(random);
  const SurfaceSlip slip = slip_of(s, slip_constants(KernelKind::peskin4, ratio, 3));
  Vec<3> force = Vec<3>::Zero(), torque = Vec<3>::Zero();
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> of_node = vector(s.forces(), i), spread = vector(slip.forces(), i);
    force += spread - of_node;
    torque += vector(slip.positions(), i).cross(spread) - s.nodes(0)[i].cross(of_node);
  }
  CHECK(force.norm() < 1e-12);
  CHECK(torque.norm() < 1e-11);
}

TEST_CASE("what the shift does to velocities is the adjoint of what it does to forces, and slip takes energy") {
  auto random = generator(84);
  const SlipConstants constants = slip_constants(KernelKind::peskin4, 5, 3);
  const double stiffness = GENERATE(0.0, 10.0);
  for (const double mobility : {0.0, constants.slip}) {
    Surfaces s = uneven_sphere(random);
    SurfaceSlip slip = slip_of(s, {constants.shift, mobility}, stiffness);
    double given = 0, taken = 0, size = 0;
    for (int i = 0; i < s.node_count(); ++i) {
      given += vector(slip.forces(), i).dot(Vec<3>(s.velocity_x[i], s.velocity_y[i], s.velocity_z[i]));
      size += vector(slip.forces(), i).norm();
    }
    slip.correct({}, s);
    for (int i = 0; i < s.node_count(); ++i)
      taken += vector(s.forces(), i).dot(Vec<3>(s.velocity_x[i], s.velocity_y[i], s.velocity_z[i]));
    if (mobility == 0) {
      CHECK(taken == Approx(given).margin(1e-13 * size));
    } else {
      CHECK(taken > given);
    }
  }
}

TEST_CASE("a surface that moves as a rigid body does so with the slip correction, too") {
  auto random = generator(85);
  Surfaces s = uneven_sphere(random);
  SurfaceSlip slip(s, {{slip_constants(KernelKind::peskin4, 5, 3), 0}}, 1.0 / 6);
  slip.measure({}, s);
  for (auto* values : {&s.force_x, &s.force_y, &s.force_z}) std::fill(values->begin(), values->end(), 0.0);
  slip.complete({}, s);
  const Vec<3> turn(0.3, -0.2, 0.5), along(0.1, 0.2, -0.4);
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> u = along + turn.cross(vector(slip.positions(), i));
    s.velocity_x[i] = u.x(), s.velocity_y[i] = u.y(), s.velocity_z[i] = u.z();
  }
  slip.correct({}, s);
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> u(s.velocity_x[i], s.velocity_y[i], s.velocity_z[i]);
    CHECK((u - along - turn.cross(s.nodes(0)[i])).norm() < 1e-12);
  }
}
