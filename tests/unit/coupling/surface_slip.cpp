// The slip correction of surfaces: conservation, adjointness, energy.
#include "core/coupling/surface_slip.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/surface/triangle_surface.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// An uneven sphere of radius 5 and 162 nodes, whose forces and velocities are random.
Surfaces uneven_sphere(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(4, {5, 5, 5}))));
  add_cell(s, 0, {9, 8, 7});
  for (auto& values : s.position) {
    for (double& value : values) value += 0.1 * any(random);
  }
  for (auto* values : {&s.force[0], &s.force[1], &s.force[2], &s.velocity[0], &s.velocity[1], &s.velocity[2]}) {
    for (double& value : *values) value = any(random);
  }
  return s;
}

SurfaceNormals normals_of(const Surfaces& s) {
  SurfaceNormals normals(s);
  normals.measure({}, s);
  return normals;
}

SurfaceSlip slip_of(const Surfaces& s, SlipConstants constants, double stiffness = 0) {
  SurfaceSlip slip(s, {{constants, stiffness}}, 1.0 / 6);
  const SurfaceNormals normals = normals_of(s);
  slip.measure({}, s, normals);
  slip.complete({}, s, normals);
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
      given += vector(slip.forces(), i).dot(Vec<3>(s.velocity[0][i], s.velocity[1][i], s.velocity[2][i]));
      size += vector(slip.forces(), i).norm();
    }
    slip.correct({}, s, normals_of(s));
    for (int i = 0; i < s.node_count(); ++i)
      taken += vector(s.forces(), i).dot(Vec<3>(s.velocity[0][i], s.velocity[1][i], s.velocity[2][i]));
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
  const SurfaceNormals normals = normals_of(s);
  slip.measure({}, s, normals);
  for (auto& values : s.force) std::fill(values.begin(), values.end(), 0.0);
  slip.complete({}, s, normals);
  const Vec<3> turn(0.3, -0.2, 0.5), along(0.1, 0.2, -0.4);
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> u = along + turn.cross(vector(slip.positions(), i));
    s.velocity[0][i] = u.x(), s.velocity[1][i] = u.y(), s.velocity[2][i] = u.z();
  }
  slip.correct({}, s, normals_of(s));
  for (int i = 0; i < s.node_count(); ++i) {
    const Vec<3> u(s.velocity[0][i], s.velocity[1][i], s.velocity[2][i]);
    CHECK((u - along - turn.cross(s.nodes(0)[i])).norm() < 1e-12);
  }
}

TEST_CASE("slip is smoothed by Fejer's kernel of the mass matrix, which bounds what it gains in a step") {
  auto random = generator(86);
  Surfaces s = uneven_sphere(random);
  const double stiffness = GENERATE(0.0, 1.0, 30.0), viscosity = 1.0 / 6;
  const SlipConstants constants{0, 0.7};  // where nodes are
  SurfaceSlip slip = slip_of(s, constants, stiffness);
  for (auto& values : s.velocity) std::fill(values.begin(), values.end(), 0.0);
  slip.correct({}, s, normals_of(s));

  // The matrix of the integrals of hat functions' products, over the areas around the nodes.
  const int n = s.node_count();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd area = Eigen::VectorXd::Zero(n);
  const Nodes nodes = s.nodes(0);
  for (const auto& corner : s.type_of(0).mesh.triangles()) {
    const double size = (nodes[corner[1]] - nodes[corner[0]]).cross(nodes[corner[2]] - nodes[corner[0]]).norm() / 2;
    for (const int i : corner) {
      area[i] += size / 3;
      for (const int j : corner) mass(i, j) += size / 12 * (i == j ? 2 : 1);
    }
  }
  const Eigen::VectorXd root = area.cwiseSqrt();
  const Eigen::MatrixXd even = root.cwiseInverse().asDiagonal() * mass * root.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(even);
  const RestSurface& rest = s.type_of(0);
  const double square = rest.rest_surface_area / rest.mesh.triangle_count() * 4 / std::sqrt(3.0);
  const double mobility = constants.slip / viscosity;
  const int order = surface_slip_smoothing(square, mobility, stiffness);
  Eigen::VectorXd share(n);
  for (int i = 0; i < n; ++i) {
    const double wave = 8 * (1 - modes.eigenvalues()[i]);
    REQUIRE((wave > -1e-12 && wave < 6 + 1e-12));
    const double chebyshev = std::cos(order * std::acos(std::clamp(1 - wave / 3, -1.0, 1.0)));
    share[i] = wave > 1e-6 ? 3 * (1 - chebyshev) / (order * order * wave) : 1;
    CHECK(share[i] > -1e-12);
    CHECK(mobility * stiffness / square * wave * share[i] < 0.3 + 1e-9);
  }
  const std::vector<Vec<3>> normals = node_normals(rest.mesh, nodes);
  const auto tangential = [&](const Eigen::MatrixXd& vectors) {
    Eigen::MatrixXd result = vectors;
    for (int i = 0; i < n; ++i) {
      const Vec<3> vector = vectors.row(i).transpose();
      result.row(i) -= vector.dot(normals[i]) * normals[i].transpose();
    }
    return result;
  };
  Eigen::MatrixXd force(n, 3);
  for (int i = 0; i < n; ++i) force.row(i) = vector(s.forces(), i).transpose();
  const Eigen::MatrixXd per_area = mobility * area.cwiseInverse().asDiagonal() * tangential(force);
  const Eigen::MatrixXd smoothed =
      tangential(root.cwiseInverse().asDiagonal() *
                 (modes.eigenvectors() *
                  (share.asDiagonal() * (modes.eigenvectors().transpose() * (root.asDiagonal() * per_area)))));
  double worst = 0;
  for (int i = 0; i < n; ++i)
    worst = std::max(
        worst, (Vec<3>(s.velocity[0][i], s.velocity[1][i], s.velocity[2][i]) - smoothed.row(i).transpose()).norm());
  CHECK(worst < 1e-11 * per_area.cwiseAbs().maxCoeff());
}
