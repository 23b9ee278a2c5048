// Forces from outside: the weight of what cells enclose, and pulls that change with time.
#include "core/solver/external_forces.hpp"

#include "core/membrane/geometry.hpp"
#include "unit/surface/fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

/// The integral of the height along `up` over what a cell encloses, from `zero`: content times the centroid's height.
double moment(const Surfaces& s, const Vec<3>& up, const Vec<3>& zero) {
  const InertiaEllipsoid body = inertia_ellipsoid(s.type_of(0).mesh, s.nodes(0));
  return enclosed_volume(s.type_of(0).mesh, s.nodes(0)) * up.dot(body.center - zero);
}
double moment(const Membranes& m, const Vec<2>& up, const Vec<2>& zero) {
  return enclosed_area(m, m.cells[0]) * up.dot(centroid(m, m.cells[0]) - zero);
}

template <int D>
Vec<D> mean_place(const Cells<D>& cells) {
  Vec<D> sum = Vec<D>::Zero();
  for (int i = 0; i < cells.node_count(); ++i) sum += vector_at<D>(cells.position, i);
  return sum / cells.node_count();
}

template <int D>
void check_weight(Cells<D> cells, const Vec<D>& weight, double content) {
  ExternalForces<D> external{.weight = {weight}};
  external.run({}, cells);
  const auto sums = external.sums(cells, {});
  const Vec<D> zero = mean_place<D>(cells);
  for (int k = 0; k < D; ++k) CHECK(sums[k] == Approx(content * weight[k]).margin(1e-12 * content));
  // Minus the gradient of the energy -W int h dV, by central differences of one node's place.
  for (const int node : {0, cells.node_count() / 3}) {
    for (int k = 0; k < D; ++k) {
      double difference = 0;
      for (const double step : {-1e-5, 1e-5}) {
        Cells<D> moved = cells;
        moved.position[k][node] += step;
        difference += moment(moved, weight, zero) / (2 * step);
      }
      CAPTURE(D, node, k);
      CHECK(cells.force[k][node] == Approx(difference).margin(1e-7));
    }
  }
}

}  // namespace

TEST_CASE("the weight of a cell is minus the gradient of its potential energy, and its sum is that of the content") {
  Surfaces surface = one_cell(ellipsoid(3, {4, 3, 5}));
  check_weight<3>(surface, {0.3, -0.2, 0.1}, surface.types[0]->rest_volume);
  std::vector<double> x, y;
  for (int i = 0; i < 24; ++i) x.push_back(5 * std::cos(i * M_PI / 12)), y.push_back(3 * std::sin(i * M_PI / 12));
  Membranes outline;
  outline.types.push_back(std::make_shared<const RestShape>(make_rest_shape(x, y)));
  add_cell(outline, 0, 7, -2, 0.4);
  check_weight<2>(outline, {0.3, -0.2}, outline.cells[0].rest_area);
}

TEST_CASE("a cell weighs what it did at rest, however it is stretched, and turns by no weight") {
  Surfaces surface = one_cell(ellipsoid(3, {4, 3, 5}));
  for (double& place : surface.position[0]) place *= 1.1;
  const Vec<3> weight(0.3, -0.2, 0.1);
  const ExternalForces<3> external{.weight = {weight}};
  external.run({}, surface);
  const Vec<3> center = inertia_ellipsoid(surface.type_of(0).mesh, surface.nodes(0)).center;
  Vec<3> force = Vec<3>::Zero(), torque = Vec<3>::Zero();
  for (int i = 0; i < surface.node_count(); ++i) {
    force += vector_at<3>(surface.force, i);
    torque += (vector_at<3>(surface.position, i) - center).cross(vector_at<3>(surface.force, i));
  }
  CHECK((force - surface.types[0]->rest_volume * weight).norm() < 1e-10);
  CHECK(torque.norm() < 1e-9);
}

TEST_CASE("a pull goes from one force to another within its ramp, and its power is that of the nodes that it acts on") {
  Surfaces surface = one_cell(ellipsoid(2, {4, 3, 5}));
  PatchForce<3> pull{.before = {1, 0, 0}, .after = {3, 2, 0}, .ramp_steps = 10};
  pull.patch = {std::make_shared<const ForcePatch>(ForcePatch{{4, 7}, {0.25, 0.75}})};
  ExternalForces<3> external{.pulls = {pull}};
  surface.velocity[0][4] = 2, surface.velocity[1][7] = 4, surface.velocity[0][1] = 100;
  for (const auto& [steps, x, y] : {std::array{0.0, 1.0, 0.0}, {5, 2, 1}, {10, 3, 2}, {1000, 3, 2}}) {
    external.steps = static_cast<long>(steps);
    const auto sums = external.sums(surface, {});
    CHECK(sums[0] == Approx(x));
    CHECK(sums[1] == Approx(y).margin(1e-15));
    CHECK(sums[3] == Approx(0.25 * x * 2 + 0.75 * y * 4));
  }
}
