// Membrane viscosity of closed surfaces: stress in given motions, balances, power, steps of any size.
#include "fixture.hpp"

using namespace rouleau;
using namespace rouleau::test;

namespace {

constexpr double shear = 0.3, dilation = 0.2;

MembraneLaws viscous(double factor = 1) { return {surface_law("viscous", {factor * shear, factor * dilation})}; }

/// The cell's shape, deformed, and the motion v = L x + drift of its nodes.
Surfaces moving_cell(const Eigen::Matrix3d& gradient, const Vec<3>& drift) {
  auto random = generator(81);
  Surfaces s = one_cell(core::biconcave_disc(6, 1));
  std::uniform_real_distribution<double> any(-0.01, 0.01);
  for (int i = 0; i < s.node_count(); ++i) {
    for (auto& places : s.position) places[i] += any(random);
    const Vec<3> v = gradient * (s.nodes(0)[i] - Vec<3>(3, -2, 5)) + drift;
    for (int k = 0; k < 3; ++k) s.velocity[k][i] = v[k];
  }
  return s;
}

/// `modulus`: one without end makes an explicit step.
SurfaceForces forces_of(Surfaces& s, const MembraneLaws& laws, double modulus = 1) {
  SurfaceForces forces(s, {laws});
  forces.take_viscosity(s, {modulus}, 1);
  return forces;
}

double power_on(const Surfaces& s) {
  double power = 0;
  for (int i = 0; i < s.node_count(); ++i) {
    power += force_on(s, i).dot(Vec<3>(s.velocity[0][i], s.velocity[1][i], s.velocity[2][i]));
  }
  return power;
}

void move_at_random(Surfaces& s, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1e-3, 1e-3);
  for (auto& velocities : s.velocity) {
    for (double& velocity : velocities) velocity = any(random);
  }
}

}  // namespace

TEST_CASE("a surface that is strained is under Evans and Hochmuth's viscous stress") {
  Eigen::Matrix3d gradient;
  gradient << 1, 2, -0.5, 0.3, -0.4, 1.5, 0.7, -1, 0.6;
  gradient *= 1e-3;
  Surfaces s = moving_cell(gradient, {0.01, 0.02, -0.03});
  SurfaceForces forces = forces_of(s, viscous(), 1e18);
  forces.run({}, s);
  // What is outside of a triangle pulls at both ends of each side by half of its length times the stress along its
  // normal.
  std::vector<Vec<3>> expected(s.position[0].size(), Vec<3>::Zero());
  double power = 0;
  for (const auto& corner : s.types[0]->mesh.triangles()) {
    const Vec<3> place[3] = {s.nodes(0)[corner[0]], s.nodes(0)[corner[1]], s.nodes(0)[corner[2]]};
    const Vec<3> normal = (place[1] - place[0]).cross(place[2] - place[0]), unit = normal.normalized();
    const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - unit * unit.transpose();
    const Eigen::Matrix3d strain = plane * (gradient + gradient.transpose()) / 2 * plane;
    const Eigen::Matrix3d stress =
        2 * shear * (strain - strain.trace() / 2 * plane) + dilation * strain.trace() * plane;
    for (int k = 0; k < 3; ++k) {
      const Vec<3> side = place[(k + 1) % 3] - place[k], pull = stress * side.cross(unit) / 2;
      expected[corner[k]] -= pull, expected[corner[(k + 1) % 3]] -= pull;
    }
    power += normal.norm() / 2 * (stress * strain).trace();
  }
  const double most = largest_force(s);
  for (int i = 0; i < s.node_count(); ++i) CHECK((force_on(s, i) - expected[i]).norm() < 1e-12 * most);
  CHECK(forces.energies(s).dissipation == Approx(power).epsilon(1e-12));
  CHECK(-power_on(s) == Approx(power).epsilon(1e-12));
  CHECK(forces.energies(s).unknown.empty());
  CHECK(forces.energies(s).total() == 0);
  // The step of any size comes to the same stress.
  s.state.clear();
  SurfaceForces stable = forces_of(s, viscous());
  for (int step = 0; step < 200; ++step) stable.run({}, s);
  for (int i = 0; i < s.node_count(); ++i) CHECK((force_on(s, i) - expected[i]).norm() < 1e-12 * most);
  CHECK(stable.energies(s).dissipation == Approx(power).epsilon(1e-12));
}

TEST_CASE("a sphere that is blown up is resisted by its area viscosity alone") {
  constexpr double rate = 1e-3;
  Surfaces s = one_cell(core::unit_sphere(8), 1);
  for (int i = 0; i < s.node_count(); ++i) {
    for (int k = 0; k < 3; ++k) s.velocity[k][i] = rate * (s.nodes(0)[i] - Vec<3>(3, -2, 5))[k];
  }
  SurfaceForces forces = forces_of(s, viscous(), 1e18);
  forces.run({}, s);
  const double area = surface_area(s.types[0]->mesh, s.nodes(0));
  CHECK(forces.energies(s).dissipation == Approx(dilation * 4 * rate * rate * area).epsilon(1e-12));
}

TEST_CASE("forces lag behind a motion that oscillates by the square of its frequency") {
  Eigen::Matrix3d gradient;
  gradient << 1, 2, -0.5, 0.3, -0.4, 1.5, 0.7, -1, 0.6;
  const auto largest_error = [&](double frequency) {
    Surfaces s = moving_cell(1e-3 * gradient, {0, 0, 0});
    SurfaceForces at_once = forces_of(s, viscous(), 1e18);
    at_once.run({}, s);
    const double most = largest_force(s), amplitude = force_on(s, 7).norm();
    const Vec<3> direction = force_on(s, 7) / amplitude;
    CHECK(amplitude > 0.1 * most);
    const auto velocity = s.velocity;
    s.state.clear();
    SurfaceForces forces = forces_of(s, viscous(10));  // lags of 5 steps
    double error = 0;
    const long period = std::lround(2 * M_PI / frequency);
    for (long step = 0; step < 4 * period; ++step) {
      for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < s.node_count(); ++i)
          s.velocity[k][i] = std::sin(frequency * static_cast<double>(step)) * velocity[k][i];
      }
      forces.run({}, s);
      const double expected = 10 * amplitude * std::sin(frequency * static_cast<double>(step));
      if (step >= 3 * period) error = std::max(error, std::abs(force_on(s, 7).dot(direction) - expected));
    }
    return error / (10 * amplitude);
  };
  const double slow = largest_error(0.005), fast = largest_error(0.01);
  CHECK(fast == Approx(std::pow(0.01 * 10 * (shear + dilation), 2)).epsilon(0.25));
  CHECK(fast / slow == Approx(4).epsilon(0.1));
}

TEST_CASE("a surface that moves as a whole has no viscous force, and no motion gives forces a sum or a torque") {
  Eigen::Matrix3d turning;
  turning << 0, -3e-3, 2e-3, 3e-3, 0, 1e-3, -2e-3, -1e-3, 0;
  Surfaces s = moving_cell(turning, {0.01, -0.02, 0.03});
  for (const double factor : {0.01, 1.0, 1000.0}) {
    SurfaceForces forces = forces_of(s, viscous(factor));
    for (int step = 0; step < 10; ++step) forces.run({}, s);
    CHECK(largest_force(s) < 1e-16 * factor);  // velocities of 0.03 are rounded to 3e-18
  }
  auto random = generator(82);
  for (const double factor : {0.01, 1.0, 1000.0}) {
    SurfaceForces forces = forces_of(s, viscous(factor));
    for (int step = 0; step < 10; ++step) {
      move_at_random(s, random);
      forces.run({}, s);
      const auto [sum, torque] = sum_and_torque(s);
      CHECK(sum.norm() < 1e-12 * largest_force(s));
      CHECK(torque.norm() < 1e-12 * largest_force(s));
    }
  }
}

TEST_CASE("whatever the viscosity a surface never gives back more than it has taken") {
  auto random = generator(83);
  for (const double factor : {0.03, 1.0, 30.0, 1000.0, 30000.0}) {
    CAPTURE(factor);
    Surfaces s = one_cell(core::biconcave_disc(6, 6));
    SurfaceForces forces = forces_of(s, viscous(factor));
    double taken = 0, least = 0, size = 0;
    for (int step = 0; step < 200; ++step) {
      if (step < 100 || step % 2 == 0) move_at_random(s, random);
      forces.run({}, s);
      taken -= power_on(s);
      size += std::abs(power_on(s));
      least = std::min(least, taken);
    }
    CHECK(least >= 0);
    CHECK(taken > 0.05 * size);
  }
}
