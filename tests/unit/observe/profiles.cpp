// Velocity and hematocrit across channels and tubes, of cells and flows whose profiles are known.
#include "observe/profiles.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/surface/triangle_surface.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::observe;
using namespace rouleau::test;

namespace {

/// A box of so many spacings of 1 um.
scene::Scene box(std::vector<int> nodes, scene::Profiles profiles) {
  scene::Scene scene;
  scene.domain.size = scene::Vector::filled(static_cast<int>(nodes.size()), 0);
  for (std::size_t k = 0; k < nodes.size(); ++k) scene.domain.size[static_cast<int>(k)] = 1e-6 * nodes[k];
  scene.domain.nodes = std::move(nodes);
  scene.domain.periodic[1] = false;
  if (profiles.radial) scene.domain.tube_radius = 14e-6, scene.domain.periodic[2] = false;
  scene.output.profiles = profiles;
  return scene;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Surfaces sphere(double radius, const Vec<3>& centre) {
  Surfaces s;
  s.types.push_back(
      std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(24, {radius, radius, radius}))));
  add_cell(s, 0, centre);
  return s;
}

}  // namespace

TEST_CASE("a rectangle fills its share of each bin, wherever these are cut, and what lies beyond the edge counts") {
  Membranes m;
  add_shape(m, make_rest_shape({2, 7, 7, 2}, {3.2, 3.2, 9.7, 9.7}));
  const int bins = GENERATE(1, 3, 20, 33);
  const scene::Scene scene = box({10, 20}, {false, bins});
  const std::vector<double> profile = hematocrit_profile(m, scene);
  const double width = 20.0 / bins;
  for (int k = 0; k < bins; ++k) {
    // Walls lie half a spacing from the first and the last node.
    const double inside = std::min((k + 1) * width, 10.2) - std::max(k * width, 3.7);
    CHECK(profile[k] == Approx(std::max(0.0, inside) * 5 / (10 * width)).margin(1e-12));
  }
  CHECK(sum(profile) * width * 10 == Approx(5 * 6.5).epsilon(1e-12));
}

TEST_CASE("in a box that is periodic along y a cell on the edge is seen at both") {
  Membranes m;
  add_shape(m, make_rest_shape({2, 7, 7, 2}, {-4.5, -4.5, 3.5, 3.5}));
  scene::Scene scene = box({10, 20}, {false, 5});
  scene.domain.periodic[1] = true;
  const std::vector<double> profile = hematocrit_profile(m, scene);
  const std::vector<double> expected{0.5, 0, 0, 0, 0.5};
  for (std::size_t k = 0; k < 5; ++k) CHECK(profile[k] == Approx(expected[k]).margin(1e-12));
}

TEST_CASE("a sphere's volume is shared out between slabs and between rings, and none of it is lost") {
  const double radius = 6;
  const Surfaces on_axis = sphere(radius, {100, 15.5, 15.5});
  const double volume = 4 * std::numbers::pi / 3 * std::pow(radius, 3);
  const scene::Scene slabs = box({40, 32, 32}, {false, 16}), rings = box({40, 32, 32}, {true, 7});
  const std::vector<double> over_y = hematocrit_profile(on_axis, slabs), over_r = hematocrit_profile(on_axis, rings);
  double of_slabs = 0, of_rings = 0;
  for (int k = 0; k < 16; ++k) {
    const auto below = [&](double y) {  // volume of the sphere up to a height above its centre
      const double h = std::clamp(y, -radius, radius);
      return std::numbers::pi * (radius * radius * h - h * h * h / 3);
    };
    of_slabs += over_y[k] * 2 * 32 * 40;
    CHECK(over_y[k] * 2 * 32 * 40 == Approx(below(2 * k - 14) - below(2 * k - 16)).margin(0.01 * volume));
  }
  for (int k = 0; k < 7; ++k) {
    const auto beyond = [&](double r) { return std::pow(std::max(0.0, radius * radius - r * r), 1.5); };
    const double section = std::numbers::pi * 4 * (2 * k + 1);
    of_rings += over_r[k] * section * 40;
    CHECK(over_r[k] * section * 40 ==
          Approx(4 * std::numbers::pi / 3 * (beyond(2 * k) - beyond(2 * k + 2))).margin(0.01 * volume));
  }
  CHECK(of_slabs == Approx(of_rings).epsilon(1e-12));
  CHECK(of_slabs == Approx(volume).epsilon(0.005));  // the sphere has corners
}

TEST_CASE("rows are spread over bins so that the flow is the same, and those of a tube stand by their distance") {
  const scene::Scene channel = box({10, 20}, {false, GENERATE(1, 4, 7, 20, 50)});
  std::vector<double> rows;
  for (int y = 0; y < 20; ++y) rows.push_back((y + 0.5) * (19.5 - y));
  const std::vector<double> profile = velocity_profile(rows, channel);
  CHECK(sum(profile) / static_cast<double>(profile.size()) == Approx(sum(rows) / 20).epsilon(1e-12));
  CHECK(place_of_bin(channel, 0) == Approx(10e-6 / channel.output.profiles->bins));

  const scene::Scene tube = box({10, 32, 32}, {true, 7});
  std::vector<double> sections;
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 32; ++y) sections.push_back(std::hypot(y - 15.5, z - 15.5));
  const std::vector<double> over_r = velocity_profile(sections, tube);
  for (int k = 0; k < 7; ++k) {
    CHECK(over_r[k] > 2 * k);
    CHECK(over_r[k] < 2 * k + 2);
  }
}
