// The layers beside the walls that no cell reaches, of membranes whose layers are known.
#include "observe/cell_free_layer.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/surface/triangle_surface.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::observe;

namespace {

/// Closed polygons through the given corners.
Membranes polygons(const std::vector<std::vector<std::array<double, 2>>>& cells) {
  Membranes m;
  for (const auto& corners : cells) {
    m.cells.push_back({{m.node_count(), static_cast<int>(corners.size())}, 0, 0, 0});
    for (const auto& corner : corners) {
      m.position[0].push_back(corner[0]);
      m.position[1].push_back(corner[1]);
    }
  }
  return m;
}

/// Spheres of one radius, with so many triangles along an edge of the icosahedron.
Surfaces spheres(double radius, const std::vector<Vec<3>>& centres, int frequency = 24) {
  Surfaces surfaces;
  surfaces.types.push_back(
      std::make_shared<const RestSurface>(core::rest_surface(core::ellipsoid(frequency, {radius, radius, radius}))));
  for (const Vec<3>& centre : centres) add_cell(surfaces, 0, centre);
  return surfaces;
}

}  // namespace

TEST_CASE("the layer without cells is the mean distance from the wall to the nearest membrane of each column") {
  // Walls at -0.5 and 39.5. A box over columns 2 ... 11 between y = 5 and 12, another over 6 ... 8 from 3.25 to 4.
  const Membranes m =
      polygons({{{1.5, 5}, {11.5, 5}, {11.5, 12}, {1.5, 12}}, {{5.5, 3.25}, {8.5, 3.25}, {8.5, 4}, {5.5, 4}}});
  const CellFreeLayer layer = cell_free_layer(m, {{20, 40}, {true, false}});
  // 10 columns without a cell count half the height, 7 meet the first box, 3 the second.
  CHECK(layer.lower == Approx((10 * 20 + 7 * 5.5 + 3 * 3.75) / 20).epsilon(1e-14));
  CHECK(layer.upper == Approx(20).epsilon(1e-14));
  CHECK(layer.empty == Approx(0.5).epsilon(1e-14));
}

TEST_CASE("the layer without cells does not depend on where the box is cut") {
  const double shift = GENERATE(0.0, 7.0, -20.0, 333.0);
  const Membranes m = polygons({{{3.2 + shift, 5}, {12.7 + shift, 9}, {9.1 + shift, 31}}});
  const CellFreeLayer layer = cell_free_layer(m, {{20, 40}, {true, false}});
  const CellFreeLayer same = cell_free_layer(polygons({{{3.2, 5}, {12.7, 9}, {9.1, 31}}}), {{20, 40}, {true, false}});
  CHECK(layer.lower == Approx(same.lower).epsilon(1e-12));
  CHECK(layer.upper == Approx(same.upper).epsilon(1e-12));
  // Mirrored at the middle of the channel (y = 19.5) the two layers change places.
  const CellFreeLayer mirrored =
      cell_free_layer(polygons({{{3.2, 34}, {12.7, 30}, {9.1, 8}}}), {{20, 40}, {true, false}});
  CHECK(mirrored.lower == Approx(same.upper).epsilon(1e-12));
  CHECK(mirrored.upper == Approx(same.lower).epsilon(1e-12));
}

TEST_CASE("a wavy membrane's layer converges to the mean of its lower side") {
  // Lower side y = 10 + 3 cos(2 pi x / 60) over the whole period: mean 10, and the wall is half a spacing below 0.
  std::vector<std::array<double, 2>> corners;
  for (int i = 0; i <= 600; ++i) corners.push_back({i * 0.1, 10 + 3 * std::cos(2 * std::numbers::pi * i / 600)});
  for (int i = 600; i >= 0; --i) corners.push_back({i * 0.1, 20});
  CHECK(cell_free_layer(polygons({corners}), {{60, 80}, {true, false}}).lower == Approx(10.5).epsilon(1e-12));
}

TEST_CASE("a sphere in the middle takes two thirds of its great circle's area times its radius from each layer") {
  // Half the volume over the area of the walls; nodes inscribed: 0.2 %, and columns instead of an integral: 0.3 %.
  const double shift = GENERATE(0.0, 13.0, -24.0);
  const CellFreeLayer layer =
      cell_free_layer(spheres(9, {{11.3 + shift, 15.5, 12.2 - shift}}), {{24, 32, 26}, {true, false, true}});
  const double taken = 2 * std::numbers::pi * std::pow(9, 3) / 3 / (24 * 26);
  CHECK(16 - layer.lower == Approx(taken).epsilon(0.005));
  CHECK(16 - layer.upper == Approx(taken).epsilon(0.005));
}

TEST_CASE("layers of surfaces change places when they are mirrored, and the nearer cell counts") {
  const Domain<3> domain{{24, 32, 26}, {true, false, false}};
  const CellFreeLayer layer = cell_free_layer(spheres(3, {{8, 4.1, 9}, {8, 11.3, 9}, {17, 25, 14}}), domain);
  const CellFreeLayer mirrored = cell_free_layer(spheres(3, {{8, 26.9, 9}, {8, 19.7, 9}, {17, 6, 14}}), domain);
  CHECK(mirrored.upper == Approx(layer.lower).epsilon(1e-3));
  CHECK(mirrored.lower == Approx(layer.upper).epsilon(1e-3));
  const CellFreeLayer nearer = cell_free_layer(spheres(3, {{8, 4.1, 9}, {17, 25, 14}}), domain);
  CHECK(nearer.lower == layer.lower);
}

TEST_CASE("in a tube a sphere on the axis leaves the radius less its meridian, a long way round") {
  // r(x) = sqrt(a^2 - x^2) is pi a^2 / 2 over the length; 0.4 % as the spheres have corners and planes are a spacing
  // apart.
  const Domain<3> domain{{24, 32, 32}, {true, false, false}};
  const double taken = std::numbers::pi * 81 / 2 / 24;
  const CellFreeLayer layer = cell_free_layer_in_tube(spheres(9, {{11.3, 15.5, 15.5}}), domain, 16);
  CHECK(16 - layer.lower == Approx(taken).epsilon(0.005));
  CHECK(16 - layer.upper == Approx(taken).epsilon(0.005));
  // Below the axis, and across x, as they are wrapped: only the lower half is met, between the tangents to it.
  const CellFreeLayer below = cell_free_layer_in_tube(spheres(3.9, {{23, 7.5, 15.5}}), domain, 16);
  const CellFreeLayer above = cell_free_layer_in_tube(spheres(3.9, {{-1, 23.5, 15.5}}), domain, 16);
  CHECK(below.upper == 16);
  CHECK(above.lower == 16);
  CHECK(above.upper == Approx(below.lower).epsilon(1e-3));
  // In the plane x the ray at an angle b from the sphere's own, of 51 on this side, ends at 8 cos b + sqrt(3.9^2 - x^2
  // - 64 sin^2 b).
  double reached = 0;
  for (int x = -3; x <= 3; ++x) {
    for (int ray = -25; ray <= 25; ++ray) {
      const double b = ray * std::numbers::pi / 51, inside = 3.9 * 3.9 - x * x - 64 * std::sin(b) * std::sin(b);
      if (inside > 0) reached += 8 * std::cos(b) + std::sqrt(inside);
    }
  }
  CHECK(16 - below.lower == Approx(reached / 24 / 51).epsilon(0.005));
}
