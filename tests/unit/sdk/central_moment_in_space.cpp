// Central moments on D3Q19 against a matrix: each moment of f - f_eq + S/2 in the frame of the fluid keeps its share.
#include <Eigen/Dense>
#include <array>
#include <random>

#include "operators.hpp"

#define rouleau_open_v1 open_central_moment_in_space
#include "collision/central-moment/central-moment.cpp"

using namespace rouleau;
using namespace rouleau::test;

namespace {

using Vector = Eigen::Vector<double, 19>;
using Matrix = Eigen::Matrix<double, 19, 19>;

// Powers of x, y and z.
constexpr int powers[19][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2},
                               {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0}, {0, 2, 1},
                               {1, 0, 2}, {0, 1, 2}, {2, 2, 0}, {2, 0, 2}, {0, 2, 2}};

/// Moments of populations whose velocities are seen from the velocity u.
Matrix moments_from(const Eigen::Vector3d& u) {
  Matrix rows;
  for (int m = 0; m < 19; ++m) {
    for (int q = 0; q < 19; ++q) {
      rows(m, q) = 1;
      for (int k = 0; k < 3; ++k) rows(m, q) *= std::pow(d3q19::velocity[q][k] - u[k], powers[m][k]);
    }
  }
  return rows;
}

/// Hermite's equilibrium and Guo's source to second order in u, and the moments u^2 v and u^2 v^2 that a Maxwellian
/// has.
std::pair<Vector, Vector> equilibrium_and_source(double density, const Eigen::Vector3d& u, const Eigen::Vector3d& force,
                                                 bool inertia) {
  Vector equilibrium, source, higher = Vector::Zero(), higher_source = Vector::Zero();
  for (int q = 0; q < 19; ++q) {
    const Eigen::Vector3d c(d3q19::velocity[q][0], d3q19::velocity[q][1], d3q19::velocity[q][2]);
    equilibrium[q] = density + 3 * c.dot(u);
    source[q] = 3 * c.dot(force);
    if (inertia) {
      equilibrium[q] += 4.5 * c.dot(u) * c.dot(u) - 1.5 * u.dot(u);
      source[q] += 9 * c.dot(u) * c.dot(force) - 3 * u.dot(force);
    }
    equilibrium[q] *= d3q19::weight[q], source[q] *= d3q19::weight[q];
  }
  if (!inertia) return {equilibrium, source};
  for (int m = 10; m < 19; ++m) {
    higher[m] = 1;
    for (int k = 0; k < 3; ++k) higher[m] *= std::pow(u[k], powers[m][k]);
    for (int k = 0; k < 3; ++k) {  // its derivative along the force
      double term = powers[m][k] * std::pow(u[k], std::max(0, powers[m][k] - 1)) * force[k];
      for (int other = 0; other < 3; ++other) term *= other == k ? 1 : std::pow(u[other], powers[m][other]);
      higher_source[m] += term;
    }
  }
  const Eigen::PartialPivLU<Matrix> populations(moments_from(Eigen::Vector3d::Zero()));
  return {equilibrium + populations.solve(higher), source + populations.solve(higher_source)};
}

/// What the operator itself makes of populations.
template <bool inertia>
Vector collided(const CentralMoment& model, const Vector& f, const Eigen::Vector3d& force, double omega) {
  Node<D3Q19, double, true, inertia> node;
  std::copy_n(f.data(), 19, node.f);
  std::copy_n(force.data(), 3, node.force);
  node.compute_moments();
  double after[19];
  model(node, model.rates(omega), after);
  return Eigen::Map<const Vector>(after);
}

}  // namespace

TEST_CASE("central moments of D3Q19 keep what their rates leave of them") {
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> deviation(-0.03, 0.03), push(-0.01, 0.01), rate(0.5, 1.8);
  const bool inertia = GENERATE(false, true);
  const bool by_magic = GENERATE(false, true);
  const double bulk = 1.1, third = 1.3, fourth = 0.9, magic = 0.2;
  const Operator op = make_operator("central-moment", "baseline", 1, inertia,
                                    {{"bulk_rate", bulk},
                                     {"third_order_rate", by_magic ? 0 : third},
                                     {"fourth_order_rate", fourth},
                                     {"magic", by_magic ? magic : 0}});
  const CentralMoment& model = static_cast<const detail::CollisionInstance<CentralMoment>*>(op.self.get())->model;
  for (int node = 0; node < 50; ++node) {
    Vector f;
    for (double& population : f) population = deviation(engine);
    Eigen::Vector3d force(push(engine), push(engine), push(engine)), u = 0.5 * force;
    for (int q = 0; q < 19; ++q) {
      for (int k = 0; k < 3; ++k) u[k] += f[q] * d3q19::velocity[q][k];
    }
    const double omega = rate(engine);
    const auto [equilibrium, source] = equilibrium_and_source(f.sum(), u, force, inertia);

    const Matrix rows = moments_from(inertia ? u : Eigen::Vector3d::Zero());
    Vector left = rows * (f - equilibrium + 0.5 * source);
    CHECK(left.head<4>().norm() < 1e-14);  // neither mass nor momentum
    const double trace = left.segment<3>(4).sum() / 3;
    left.segment<3>(4) = (1 - omega) * (left.segment<3>(4).array() - trace) + (1 - bulk) * trace;
    left.segment<3>(7) *= 1 - omega;
    left.segment<6>(10) *= 1 - (by_magic ? 1 / (0.5 + magic / (1 / omega - 0.5)) : third);
    left.segment<3>(16) *= 1 - fourth;
    const Vector expected = equilibrium + 0.5 * source + rows.partialPivLu().solve(left);

    const Vector found = inertia ? collided<true>(model, f, force, omega) : collided<false>(model, f, force, omega);
    CHECK((found - expected).lpNorm<Eigen::Infinity>() < 1e-15);
  }
}
