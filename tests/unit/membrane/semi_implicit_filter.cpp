// The semi-implicit step's filter against the matrix it inverts.
#include "core/membrane/semi_implicit_filter.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "core/membrane/membrane_forces.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

TEST_CASE("the filter is the inverse of the cyclic matrix of stretching and bending") {
  auto random = generator(201);
  std::normal_distribution<double> normal(0, 1);
  const int n = GENERATE(8, 9, 33, 100);
  const auto [length, stretching, bending] =
      GENERATE(table<double, double, double>({{1, 0, 0}, {0.7, 3, 0}, {1.3, 0, 5}, {0.9, 60, 900}, {0.9, 6e4, 9e5}}));
  Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    difference(i, i) = 2;
    difference(i, (i + 1) % n) = difference((i + 1) % n, i) = -1;
  }
  const Eigen::MatrixXd matrix =
      Eigen::MatrixXd::Identity(n, n) +
      0.5 / length * (stretching / length * difference + bending / std::pow(length, 3) * difference * difference);
  Eigen::VectorXd x(n), y(n);
  for (int i = 0; i < n; ++i) x(i) = normal(random), y(i) = normal(random);
  const double eigenvalue = 0.5 / length * (4 * stretching / length + 16 * bending / std::pow(length, 3));
  const double share = 1 / (1 + 8 * eigenvalue);  // of the first force that the mean takes in
  const Eigen::VectorXd force = x, force_y = y;
  const Eigen::VectorXd exact_x = share * x + (1 - share) * matrix.partialPivLu().solve(x),
                        exact_y = share * y + (1 - share) * matrix.partialPivLu().solve(y);
  const double sum = x.sum();
  std::vector<double> held_x(static_cast<std::size_t>(n)), held_y = held_x;
  const SemiImplicitFilter filter(n, length, 1, 1.0 / 6, stretching, bending);
  filter.apply(x.data(), y.data(), held_x.data(), held_y.data());
  // Rounding, times the condition number of at most 1 + 16 m k.
  const double tolerance = 1e-15 * matrix.norm() + 1e-14;
  CHECK((x - exact_x).norm() < tolerance * exact_x.norm() + tolerance);
  CHECK((y - exact_y).norm() < tolerance * exact_y.norm() + tolerance);
  CHECK(std::abs(x.sum() - sum) < tolerance * n);

  // Of a force that lasts nothing is held back.
  if (share < 1e-4) return;
  for (int step = 0; step < 40 / share; ++step) {
    x = force, y = force_y;
    filter.apply(x.data(), y.data(), held_x.data(), held_y.data());
  }
  CHECK((x - force).norm() < 1e-12 * force.norm());
  CHECK((y - force_y).norm() < 1e-12 * force_y.norm());
}

TEST_CASE("semi-implicit forces sum to zero and are the explicit ones where nothing is stiff") {
  auto random = generator(202);
  Membranes m = biconcave_cells({{100, 60, 0.4}, {160, 70, 2}});
  deform(m, random, 4, 0.1);
  Membranes soft = m, stiff = m;
  const MembraneLaws weak_laws = {neo_hookean(1e-9), bending(1e-9)}, strong_laws = {neo_hookean(20), bending(60)};
  MembraneForces without(m, {.laws = {weak_laws}}), with(soft, {.laws = {weak_laws}, .semi_implicit = true}),
      strong(stiff, {.laws = {strong_laws}, .semi_implicit = true});
  without.run({}, m);
  with.run({}, soft);
  strong.run({}, stiff);
  const ForceSums sums = force_sums(stiff);
  CHECK(std::abs(sums.x) < 1e-12 * sums.size);
  CHECK(std::abs(sums.y) < 1e-12 * sums.size);
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    REQUIRE(soft.force[0][i] == Approx(m.force[0][i]).margin(1e-17));
}

TEST_CASE("a semi-implicit step looks one step ahead") {
  auto random = generator(203);
  Membranes m = biconcave_cells({{100, 60, 0.4}});
  deform(m, random, 4, 0.1);
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    m.velocity[0][i] = 0.01 * m.position[1][i], m.velocity[1][i] = -0.02;
  Membranes moved = m;
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    moved.position[0][i] += m.velocity[0][i], moved.position[1][i] += m.velocity[1][i];
  moved.velocity[0].assign(m.position[0].size(), 0), moved.velocity[1].assign(m.position[0].size(), 0);
  MembraneForces forces(m, {.laws = {{neo_hookean(2), bending(3)}}, .semi_implicit = true});
  moved.state = m.state;
  forces.run({}, m);
  forces.run({}, moved);
  CHECK(m.force[0] == moved.force[0]);
  CHECK(m.force[1] == moved.force[1]);
}
