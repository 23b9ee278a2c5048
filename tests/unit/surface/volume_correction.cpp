// Volumes that are kept: balances, the adjoint, the leak that is reported, and the way back to a volume at rest.
#include "core/surface/volume_correction.hpp"

#include <random>

#include "fixture.hpp"
#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// cells_out_of_shape() with forces and velocities at random.
Surfaces cells_at_random(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Surfaces s = cells_out_of_shape(random);
  for (auto* numbers : {&s.force[0], &s.force[1], &s.force[2], &s.velocity[0], &s.velocity[1], &s.velocity[2]}) {
    numbers->resize(s.position[0].size());
    for (double& number : *numbers) number = any(random);
  }
  s.area_leakage.assign(2, 0.0);
  return s;
}

double volume(const Surfaces& s, int cell) { return enclosed_volume(s.type_of(cell).mesh, s.nodes(cell)); }

/// The types' volumes at rest become those of the cells, so that there is no way back.
void rest_as_they_are(Surfaces& s) {
  for (int cell = 0; cell < 2; ++cell) {
    RestSurface rest = s.type_of(cell);
    rest.rest_volume = volume(s, cell);
    s.types[cell] = std::make_shared<const RestSurface>(rest);
  }
}

/// Nodes go `steps` times as far as their velocities take them in one.
void move(Surfaces& s, double steps) {
  for (int i = 0; i < s.node_count(); ++i)
    s.position[0][i] += steps * s.velocity[0][i], s.position[1][i] += steps * s.velocity[1][i],
        s.position[2][i] += steps * s.velocity[2][i];
}

struct Sums {
  Vec<3> force = Vec<3>::Zero(), torque = Vec<3>::Zero();
  double size = 0;
};
Sums sums(const Surfaces& s, int cell) {
  Sums result;
  const Vec<3> origin = s.nodes(cell)[0];
  for (int i = s.cells[cell].first; i < s.cells[cell].end(); ++i) {
    const Vec<3> force(s.force[0][i], s.force[1][i], s.force[2][i]),
        place(s.position[0][i], s.position[1][i], s.position[2][i]);
    result.force += force, result.torque += (place - origin).cross(force), result.size += force.norm();
  }
  return result;
}

}  // namespace

TEST_CASE("forces without their pressure do no work on the volume and have the same sum and torque") {
  auto random = generator(91);
  Surfaces s = cells_at_random(random);
  const Sums before[] = {sums(s, 0), sums(s, 1)};
  take_out_pressures({}, s, normals_of(s));
  for (int cell = 0; cell < 2; ++cell) {
    const Sums after = sums(s, cell);
    CHECK((after.force - before[cell].force).norm() < 1e-13 * after.size);
    CHECK((after.torque - before[cell].torque).norm() < 1e-11 * after.size);
  }
  // Nodes that go along the forces, a little forth and back: the volume's difference is the forces' work on it.
  s.velocity[0] = s.force[0], s.velocity[1] = s.force[1], s.velocity[2] = s.force[2];
  constexpr double little = 1e-5;
  Surfaces forth = s, back = s;
  move(forth, little), move(back, -little);
  for (int cell = 0; cell < 2; ++cell)
    CHECK(std::abs(volume(forth, cell) - volume(back, cell)) / (2 * little) < 1e-6 * sums(s, cell).size);
}

TEST_CASE("what the fluid gets from forces without pressure is what cells lose that keep their volume") {
  auto random = generator(92);
  Surfaces s = cells_at_random(random);
  rest_as_they_are(s);
  Surfaces spread = s;
  const SurfaceNormals normals = normals_of(s);
  take_out_pressures({}, spread, normals);
  const auto power = [](const Surfaces& forces, const Surfaces& motion) {
    double sum = 0;
    for (int i = 0; i < forces.node_count(); ++i) {
      sum += forces.force[0][i] * motion.velocity[0][i] + forces.force[1][i] * motion.velocity[1][i] +
             forces.force[2][i] * motion.velocity[2][i];
    }
    return sum;
  };
  const double fluid = power(spread, s);
  keep_enclosed({}, s, normals);
  CHECK(std::abs(fluid - power(s, s)) < 1e-12 * s.node_count());
  CHECK(std::abs(fluid) > 1e-3);
}

TEST_CASE("the volume correction makes no cell larger or smaller, and tells what would have been, for any workers") {
  auto random = generator(93);
  Surfaces s = cells_at_random(random);
  rest_as_they_are(s);
  for (auto& velocity : s.velocity) {
    for (double& v : velocity) v *= 1e-4;
  }
  Surfaces free = s, shared = s;
  move(free, 1);
  const SurfaceNormals normals = normals_of(s);
  keep_enclosed({}, s, normals);
  for (int worker = 0; worker < 3; ++worker) keep_enclosed({worker, 3}, shared, normals);
  CHECK(shared.velocity[0] == s.velocity[0]);
  CHECK(shared.area_leakage == s.area_leakage);
  move(s, 1);
  for (int cell = 0; cell < 2; ++cell) {
    const double rest = s.type_of(cell).rest_volume, leak = 1 - volume(free, cell) / rest;
    CHECK(s.area_leakage[cell] == Approx(leak).epsilon(1e-2));
    CHECK(std::abs(leak) > 1e-6);
    // What is left is of second order in the displacement of 1e-4.
    CHECK(std::abs(volume(s, cell) / rest - 1) < 1e-8);
  }
}

TEST_CASE("in a steady flow the leak of volume that is told is that of a strain of one") {
  auto random = generator(95);
  Surfaces s = cells_at_random(random);
  rest_as_they_are(s);
  const Surfaces before = s;
  const SurfaceNormals normals = normals_of(s);
  keep_enclosed({}, s, normals, 0.01);
  const std::vector<double> leak = s.area_leakage;
  for (int step = 1; step < 1000; ++step) {
    s.velocity[0] = before.velocity[0], s.velocity[1] = before.velocity[1], s.velocity[2] = before.velocity[2];
    keep_enclosed({}, s, normals, 0.01);
  }
  for (int cell = 0; cell < 2; ++cell) CHECK(s.area_leakage[cell] == Approx(leak[cell] / 0.01).epsilon(0.01));
}

TEST_CASE("the volume correction brings a wrong volume back") {
  auto random = generator(94);
  Surfaces s = cells_at_random(random);
  rest_as_they_are(s);
  RestSurface larger = s.type_of(1);
  larger.rest_volume *= 1.01;
  s.types[1] = std::make_shared<const RestSurface>(larger);
  for (int step = 0; step < 500; ++step) {
    for (auto& velocity : s.velocity) std::fill(velocity.begin(), velocity.end(), 0.0);
    keep_enclosed({}, s, normals_of(s));
    move(s, 1);
  }
  CHECK(std::abs(volume(s, 0) / s.type_of(0).rest_volume - 1) < 1e-12);
  // A fiftieth of the difference goes in each step.
  CHECK(volume(s, 1) / larger.rest_volume - 1 == Approx(-0.01 / 1.01 * std::pow(0.98, 500)).epsilon(0.02));
}
