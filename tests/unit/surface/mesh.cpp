// Meshes, their geometry, and how their curvature converges.
#include <numbers>

#include "fixture.hpp"

using namespace rouleau;
using namespace rouleau::test;
using Catch::Matchers::Contains;

namespace {

constexpr double pi = std::numbers::pi;

/// Largest error of the sum of both curvatures at any node of a sphere of radius 1, where it is 2.
double curvature_error(int n) {
  const RestSurface sphere = core::rest_surface(core::unit_sphere(n));
  double worst = 0;
  for (const double c : sphere.rest_curvature) worst = std::max(worst, std::abs(c - 2) / 2);
  return worst;
}

/// Energy of a Helfrich membrane of modulus 1 without spontaneous curvature: half of the integral of (c1 + c2)^2.
double helfrich_energy(const core::TriangleSurface& shape) {
  const RestSurface rest = core::rest_surface(shape);
  double sum = 0;
  for (std::size_t i = 0; i < rest.node_area.size(); ++i) {
    sum += 0.5 * rest.rest_curvature[i] * rest.rest_curvature[i] * rest.node_area[i];
  }
  return sum;
}

/// The same of a surface of revolution by quadrature: r(t), y(t), t from 0 to pi.
template <class Profile>
double helfrich_of_revolution(const Profile& profile) {
  constexpr int steps = 20000;
  constexpr double h = 1e-4;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double t = pi * (i + 0.5) / steps;
    const Eigen::Vector2d before = profile(t - h), here = profile(t), after = profile(t + h);
    const Eigen::Vector2d first = (after - before) / (2 * h), second = (after - 2 * here + before) / (h * h);
    const double speed = first.norm();
    const double along = -(first.x() * second.y() - first.y() * second.x()) / (speed * speed * speed);
    const double around = -first.y() / (speed * here.x());
    sum += 0.5 * (along + around) * (along + around) * 2 * pi * here.x() * speed * pi / steps;
  }
  return sum;
}

}  // namespace

TEST_CASE("a divided icosahedron has 20 n^2 triangles of nearly the same size on the sphere") {
  for (const int n : {1, 2, 5, 8}) {
    const RestSurface sphere = core::rest_surface(core::unit_sphere(n));
    CHECK(sphere.mesh.triangle_count() == 20 * n * n);
    CHECK(sphere.mesh.node_count() == 10 * n * n + 2);
    CHECK(sphere.mesh.edge_count() == 30 * n * n);
    double least = 1e9, most = 0;
    for (const Mesh::Edge& edge : sphere.mesh.edges()) {
      const double length = (sphere.nodes()[edge.a] - sphere.nodes()[edge.b]).norm();
      least = std::min(least, length), most = std::max(most, length);
    }
    CHECK(most < 1.25 * least);
  }
}

TEST_CASE("what is no closed surface is refused with its place") {
  const core::TriangleSurface good = core::unit_sphere(2);
  const auto fault = [&](auto change) {
    std::vector<std::array<int, 3>> triangles = good.triangles;
    int nodes = static_cast<int>(good.nodes.size());
    change(triangles, nodes);
    try {
      Mesh mesh(nodes, triangles);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("no fault");
  };
  CHECK(fault([](auto&, int&) {}) == "no fault");
  CHECK_THAT(fault([](auto& t, int&) { t.pop_back(); }), Contains("the surface is not closed"));
  CHECK_THAT(fault([](auto& t, int&) { std::swap(t[3][0], t[3][1]); }), Contains("in the same direction"));
  CHECK_THAT(fault([](auto&, int& nodes) { ++nodes; }), Contains("belongs to no triangle"));
  CHECK_THAT(fault([](auto& t, int&) { t[5][1] = t[5][0]; }), Contains("triangle 5 has a node twice"));
  CHECK_THAT(fault([](auto& t, int&) { t[5][1] = 1000; }), Contains("triangle 5 has the node 1000"));
  CHECK_THAT(fault([](auto& t, int& nodes) {
               const auto once = t;
               for (auto triangle : once) {
                 for (int& node : triangle) node += nodes;
                 t.push_back(triangle);
               }
               nodes *= 2;
             }),
             Contains("several pieces"));
  // Two spheres that share a node only; and every triangle once more.
  CHECK_THAT(fault([](auto& t, int& nodes) {
               const auto once = t;
               for (auto triangle : once) {
                 for (int& node : triangle) node = node == 0 ? 0 : node + nodes - 1;
                 t.push_back(triangle);
               }
               nodes = 2 * nodes - 1;
             }),
             Contains("several pieces"));
  CHECK_THAT(fault([](auto& t, int&) { t.push_back(t[0]); }), Contains("in the same direction"));
}

TEST_CASE("volume, area and inertia of an ellipsoid converge with the second order") {
  double before[3] = {0, 0, 0};
  for (const int n : {6, 12}) {
    const Surfaces s = one_cell(core::ellipsoid(n, {1.5, 1, 0.7}));
    const Mesh& mesh = s.types[0]->mesh;
    const InertiaEllipsoid ellipsoid = inertia_ellipsoid(mesh, s.nodes(0));
    const PlaneDeformation plane = deformation_in_xy(ellipsoid);
    const double errors[3] = {
        enclosed_volume(mesh, s.nodes(0)) / (4 * pi / 3 * 1.5 * 0.7) - 1,
        // By the midpoint rule over the angles of its parameters, with 360 000 points, extrapolated.
        s.types[0]->rest_surface_area / 13.984245 - 1, ellipsoid.semi_axes[0] / 1.5 - 1};
    for (int k = 0; k < 3; ++k) {
      CHECK(std::abs(errors[k]) < 0.02);
      if (before[k] != 0) CHECK(before[k] / errors[k] == Approx(4).epsilon(0.05));
      before[k] = errors[k];
    }
    CHECK((ellipsoid.center - Vec<3>(3, -2, 5)).norm() < 1e-12);
    CHECK(plane.deformation == Approx(0.2).epsilon(0.01));
    CHECK(std::abs(plane.angle) < 1e-12);
  }
}

TEST_CASE("areas of nodes add up to the surface, also where triangles are obtuse") {
  const RestSurface cell = core::rest_surface(core::ellipsoid(5, {4, 1, 0.3}));
  double sum = 0;
  for (const double area : cell.node_area) {
    CHECK(area > 0);
    sum += area;
  }
  CHECK(sum == Approx(cell.rest_surface_area).epsilon(1e-13));
}

TEST_CASE("the curvature of a sphere is right in every node, the twelve five-fold ones too, with the second order") {
  CHECK(curvature_error(8) < 0.01);  // 642 nodes
  CHECK(curvature_error(8) / curvature_error(16) == Approx(4).epsilon(0.15));
  CHECK(curvature_error(16) / curvature_error(32) == Approx(4).epsilon(0.1));
}

TEST_CASE("bending energies converge to those of sphere, ellipsoid and biconcave disc") {
  const auto order = [](auto shape, double exact, double bound) {
    double before = 0;
    for (const int n : {8, 16, 32}) {
      const double error = std::abs(helfrich_energy(shape(n)) / exact - 1);
      CAPTURE(n, error);
      if (n == 8) CHECK(error < bound);
      if (before > 0) CHECK(before / error > 3);
      before = error;
    }
  };
  order([](int n) { return core::unit_sphere(n); }, 8 * pi, 2e-3);
  order(
      [](int n) {
        return core::ellipsoid(n, {1, 0.6, 1});
      },
      helfrich_of_revolution([](double t) { return Eigen::Vector2d(std::sin(t), 0.6 * std::cos(t)); }), 0.01);
  order([](int n) { return core::biconcave_disc(n, 1); },
        helfrich_of_revolution([](double t) { return core::biconcave_curve(1, pi / 2 - t).place; }), 0.03);
}

TEST_CASE("the biconcave disc has the size of a red blood cell and even triangles") {
  const RestSurface cell = core::rest_surface(core::biconcave_disc(24, 3.91));
  // Evans and Fung, Microvasc. Res. 4 (1972): 94 um3 and 135 um2 for this radius.
  CHECK(cell.rest_volume == Approx(94).epsilon(0.02));
  CHECK(cell.rest_surface_area == Approx(135).epsilon(0.02));
  double least = 1e9, most = 0;
  for (const Mesh::Edge& edge : cell.mesh.edges()) {
    const double length = (cell.nodes()[edge.a] - cell.nodes()[edge.b]).norm();
    least = std::min(least, length), most = std::max(most, length);
  }
  CHECK(most < 1.75 * least);
}
