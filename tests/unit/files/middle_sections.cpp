// The outlines that pictures show of surfaces.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/surface/triangle_surface.hpp"
#include "files/middle_sections.hpp"

using namespace rouleau;

namespace {

void add(observe::OutlineSnapshot& s, const core::TriangleSurface& surface, const core::Vec<3>& at) {
  if (s.first.empty()) s.first.push_back(0);
  const int before = s.first.back();
  for (const core::Vec<3>& node : surface.nodes) {
    s.x.push_back(node.x() + at.x());
    s.y.push_back(node.y() + at.y());
    s.z.push_back(node.z() + at.z());
    s.tension.push_back(node.x());
  }
  for (const auto& [a, b, c] : surface.triangles) s.triangles.push_back({before + a, before + b, before + c});
  s.first.push_back(before + static_cast<int>(surface.nodes.size()));
}

}  // namespace

TEST_CASE("surfaces are cut through their middles into outlines of equal pieces") {
  observe::OutlineSnapshot surfaces;
  add(surfaces, core::ellipsoid(12, {3, 2, 1}), {5, 7, 40});
  add(surfaces, core::biconcave_disc(12, 4), {-3, 0, 1});
  const observe::OutlineSnapshot sections = files::middle_sections(surfaces, 100);
  REQUIRE(sections.first == std::vector<int>{0, 100, 200});
  REQUIRE(sections.x.size() == 200);
  CHECK(sections.z.empty());
  double twice_area = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double x = sections.x[i] - 5, y = sections.y[i] - 7;
    CHECK(x * x / 9 + y * y / 4 == Approx(1).margin(0.02));
    CHECK(sections.tension[i] == Approx(x).margin(1e-9));
    const std::size_t next = (i + 1) % 100;
    twice_area += sections.x[i] * sections.y[next] - sections.y[i] * sections.x[next];
    CHECK(std::hypot(sections.x[next] - sections.x[i], sections.y[next] - sections.y[i]) ==
          Approx(0.1586).epsilon(0.02));
  }
  CHECK(sections.x[0] == Approx(8).margin(0.02));
  CHECK(twice_area / 2 == Approx(6 * 3.14159265).epsilon(0.01));
  // The disc's axis lies along y: in its middle it is thinner than at its rim.
  double in_middle = 0, widest = 0;
  for (std::size_t i = 100; i < 200; ++i) {
    const double x = sections.x[i] + 3, y = std::abs(sections.y[i]);
    if (std::abs(x) < 0.3) in_middle = std::max(in_middle, y);
    widest = std::max(widest, y);
  }
  CHECK(in_middle < 0.5 * widest);
}

TEST_CASE("a surface whose nodes are no numbers has an outline all the same") {
  observe::OutlineSnapshot surfaces;
  add(surfaces, core::ellipsoid(3, {1, 1, 1}), {0, 0, 0});
  for (double& z : surfaces.z) z = std::nan("");
  CHECK(files::middle_sections(surfaces, 16).x.size() == 16);
}
