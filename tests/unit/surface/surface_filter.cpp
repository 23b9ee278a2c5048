// The semi-implicit step of surfaces: its filter against the matrix that it inverts, built here from the angles of the
// triangles.
#include "core/surface/surface_filter.hpp"

#include <Eigen/Dense>

#include "fixture.hpp"

using namespace rouleau;
using namespace rouleau::test;

namespace {

double cotangent(const Vec<3>& at, const Vec<3>& one, const Vec<3>& other) {
  const Vec<3> a = one - at, b = other - at;
  return a.dot(b) / a.cross(b).norm();
}

/// Half the cotangents of the two angles across an edge.
Eigen::MatrixXd minus_laplacian(const RestSurface& rest) {
  const auto nodes = rest.nodes();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rest.mesh.node_count(), rest.mesh.node_count());
  for (const auto& corner : rest.mesh.triangles()) {
    for (int k = 0; k < 3; ++k) {
      const int a = corner[k], b = corner[(k + 1) % 3], across = corner[(k + 2) % 3];
      const double half = 0.5 * cotangent(nodes[across], nodes[a], nodes[b]);
      matrix(a, a) += half, matrix(b, b) += half;
      matrix(a, b) -= half, matrix(b, a) -= half;
    }
  }
  return matrix;
}

Eigen::VectorXd areas(const RestSurface& rest) {
  return Eigen::Map<const Eigen::VectorXd>(rest.node_area.data(), rest.mesh.node_count());
}

}  // namespace

TEST_CASE("the filter of surfaces is the inverse of the matrix of stretching and bending") {
  auto random = generator(211);
  std::normal_distribution<double> normal(0, 1);
  const double radius = GENERATE(3, 40);  // nodes 0.6 and 8 spacings apart
  const RestSurface rest = core::rest_surface(core::biconcave_disc(4, radius));
  const int n = rest.mesh.node_count();
  const auto [stretching, bending] = GENERATE(table<double, double>({{0, 0}, {3, 0}, {0, 500}, {60, 900}, {6e3, 9e4}}));
  const Eigen::MatrixXd laplacian = minus_laplacian(rest);
  const Eigen::VectorXd area = areas(rest);
  const Eigen::MatrixXd per_area = area.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd yielding =
      0.5 * (stretching * laplacian + bending * laplacian * per_area * laplacian) * per_area;
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n) + yielding;
  const double largest = yielding.eigenvalues().real().maxCoeff();

  CAPTURE(radius, stretching, bending);
  const core::SurfaceFilter filter(rest, 1.0 / 6, stretching, bending);
  // Waves that the lattice does not feel are left aside: on the fine mesh nearly all that resist much.
  if (radius > 10) CHECK(filter.largest_eigenvalue() == Approx(largest).epsilon(0.02));
  CHECK(filter.largest_eigenvalue() <= largest * (1 + 1e-9));
  if (radius < 10 && largest > 0) CHECK(filter.largest_eigenvalue() < 0.3 * largest);

  const double share = 1 / (1 + 8 * filter.largest_eigenvalue());  // of the first force that the mean takes in
  Eigen::MatrixXd force(n, 3), held = Eigen::MatrixXd::Zero(n, 3);
  for (int i = 0; i < force.size(); ++i) force(i) = normal(random);
  const Eigen::MatrixXd given = force;
  const Eigen::MatrixXd exact = share * given + (1 - share) * matrix.partialPivLu().solve(given);
  core::PolynomialRoom work;
  const auto apply = [&] {
    filter.apply({&force(0, 0), &force(0, 1), &force(0, 2)}, {&held(0, 0), &held(0, 1), &held(0, 2)}, work);
  };
  apply();
  const double tolerance = 1e-14 * (1 + largest);  // rounding, times the condition number
  // The polynomial is right to 1 % of the inverse's least eigenvalue.
  CHECK((force - exact).norm() < (filter.terms() > 0 ? 0.01 / (1 + largest) : tolerance) * given.norm());
  CHECK((force.colwise().sum() - given.colwise().sum()).norm() < tolerance * given.norm());

  // Of a force that lasts nothing is held back.
  if (share < 1e-3) return;
  for (int step = 0; step < 40 / share; ++step) {
    force = given;
    apply();
  }
  CHECK((force - given).norm() < 1e-12 * given.norm());
}

TEST_CASE("a bending stiffness that the explicit step bears is left out of the filter") {
  auto random = generator(213);
  std::normal_distribution<double> normal(0, 1);
  const RestSurface rest = core::rest_surface(core::biconcave_disc(4, 3));
  std::vector<double> given(rest.x.size());
  for (double& force : given) force = normal(random);
  // What it makes of a force without the share that its mean takes in.
  const auto filtered = [&](double bending) {
    const core::SurfaceFilter filter(rest, 1.0 / 6, 60, bending);
    const double share = 1 / (1 + 8 * filter.largest_eigenvalue());
    std::vector<double> x(given), y(given), z(given), none(given.size()), other(none), last(none);
    core::PolynomialRoom work;
    filter.apply({x.data(), y.data(), z.data()}, {none.data(), other.data(), last.data()}, work);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = (x[i] - share * given[i]) / (1 - share);
    return x;
  };
  const auto difference = [&](double bending) {
    const std::vector<double> without = filtered(0), with = filtered(bending);
    double most = 0;
    for (std::size_t i = 0; i < with.size(); ++i) most = std::max(most, std::abs(with[i] - without[i]));
    return most;
  };
  CHECK(difference(0.1) < 1e-12);
  CHECK(difference(0.5) > 1e-4);
}

TEST_CASE("what a membrane of a sphere resists is what the sphere's second harmonic says") {
  // On a sphere of radius R minus the Laplacian of a harmonic of degree l is l (l + 1)/R^2 times it; xy has degree 2.
  constexpr double radius = 6, stretching = 40, bending = 300;
  const RestSurface rest = core::rest_surface(core::ellipsoid(8, {radius, radius, radius}));
  const int n = rest.mesh.node_count();
  std::vector<double> x(n), y(n), z(n), none(n), other(n), last(n);
  core::PolynomialRoom work;
  for (int i = 0; i < n; ++i) x[i] = rest.node_area[i] * rest.x[i] * rest.y[i];
  const std::vector<double> given = x;
  core::SurfaceFilter(rest, 1.0 / 6, stretching, bending)
      .apply({x.data(), y.data(), z.data()}, {none.data(), other.data(), last.data()}, work);
  const double second = 6 / (radius * radius), resisted = 0.5 * (stretching * second + bending * second * second);
  double along = 0, square = 0;
  for (int i = 0; i < n; ++i) along += x[i] * given[i], square += given[i] * given[i];
  CHECK(along / square == Approx(1 / (1 + resisted)).epsilon(0.02));
}

TEST_CASE(
    "semi-implicit forces of surfaces sum to zero, are the explicit ones where nothing is stiff, and look one step "
    "ahead") {
  auto random = generator(212);
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  Surfaces s = one_cell(core::biconcave_disc(6, 3));
  for (auto& numbers : s.position) {
    for (double& number : numbers) number += any(random);
  }
  const auto forces_of = [](Surfaces& cells, double modulus, bool semi_implicit) {
    SurfaceForces forces(cells, {{surface_law("neo-hookean", {modulus, 0}), surface_law("bending", {modulus, 0, 0})}});
    if (semi_implicit) forces.take_semi_implicit_steps(cells, 1.0 / 6, 1, {{}});
    forces.run({}, cells);
  };
  Surfaces weak = s, explicitly = s;
  forces_of(weak, 1e-9, true);
  forces_of(explicitly, 1e-9, false);
  CHECK((force_on(weak, 17) - force_on(explicitly, 17)).norm() < 1e-6 * largest_force(explicitly));
  REQUIRE(largest_force(explicitly) > 0);

  for (auto& numbers : s.velocity) {
    for (double& number : numbers) number = any(random);
  }
  Surfaces moved = s;
  for (int i = 0; i < s.node_count(); ++i) {
    moved.position[0][i] += s.velocity[0][i], moved.position[1][i] += s.velocity[1][i],
        moved.position[2][i] += s.velocity[2][i];
  }
  for (auto& numbers : moved.velocity) {
    std::fill(numbers.begin(), numbers.end(), 0.0);
  }
  forces_of(s, 20, true);
  forces_of(moved, 20, true);
  CHECK(s.force[0] == moved.force[0]);
  CHECK(s.force[2] == moved.force[2]);
  Vec<3> sum = Vec<3>::Zero();
  for (int i = 0; i < s.node_count(); ++i) sum += force_on(s, i);
  CHECK(sum.norm() < 1e-11 * largest_force(s));
}
