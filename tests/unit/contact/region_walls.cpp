// Walls of any shape that act on cells: forces are minus the gradient of the energy.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "core/contact/wall_contacts.hpp"
#include "core/geometry/faceted.hpp"
#include "core/geometry/formulas.hpp"
#include "core/surface/triangle_surface.hpp"
#include "unit/cell_fixture.hpp"
#include "unit/fake_models.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

constexpr double stiffness = 0.3, rest = 1.2, cutoff = 3;

/// A circle or a sphere of radius 4 in the middle.
Membranes cell_at(const Vec<2>& center) {
  std::vector<double> x, y;
  for (int i = 0; i < 60; ++i) {
    const double angle = 0.05 + 2 * std::numbers::pi * i / 60;
    x.push_back(center[0] + 4 * std::cos(angle)), y.push_back(center[1] + 4 * std::sin(angle));
  }
  Membranes m;
  add_shape(m, make_rest_shape(std::move(x), std::move(y)));
  return m;
}
Surfaces cell_at(const Vec<3>& center) {
  Surfaces s;
  s.types.push_back(std::make_shared<const RestSurface>(rest_surface(ellipsoid(5, {4, 4, 4}))));
  add_cell(s, 0, center);
  return s;
}

/// Forces against differences of the energy, along all axes; `periods`: along x, that the cell is moved by first.
template <int D>
void check_gradient(const char* what, const Domain<D>& domain, const RegionPointer<D>& region, const Vec<D>& center,
                    int periods = 0) {
  CAPTURE(what, periods);
  auto cells = cell_at(center);
  for (double& x : cells.position[0]) x += periods * domain.size[0];
  WallContacts<D> walls(cells, {{0, spring_potential(stiffness, rest, cutoff)}}, domain, region);
  cells.resize_to_positions();
  for (auto& force : cells.force) std::fill(force.begin(), force.end(), 0.0);
  walls.run({}, cells);
  double largest = 0;
  for (int k = 0; k < D; ++k) {
    for (const double force : cells.force[k]) largest = std::max(largest, std::abs(force));
  }
  REQUIRE(largest > 0.03);
  constexpr double h = 1e-5;
  double worst = 0, sum = 0;
  for (int k = 0; k < D; ++k) {
    for (std::size_t i = 0; i < cells.position[k].size(); ++i) {
      double& place = cells.position[k][i];
      const double here = place;
      place = here + h;
      const double above = walls.energy(cells);
      place = here - h;
      const double below = walls.energy(cells);
      place = here;
      worst = std::max(worst, std::abs((below - above) / (2 * h) - cells.force[k][i]));
      if (k == 0) sum += cells.force[k][i];
    }
  }
  CHECK(worst < 1e-7);
  CHECK(walls.net_force(cells, {}, 0) == Approx(sum).margin(1e-12));
}

RegionPointer<2> polygon(const std::vector<Vec<2>>& corners) {
  Border<2> border{corners, {}};
  const int n = static_cast<int>(corners.size());
  for (int i = 0; i < n; ++i) border.facets.push_back({i, (i + 1) % n});
  return std::make_shared<FacetedRegion<2>>(border);
}
/// Around a place a triangle with one acute corner, its sides counter-clockwise.
RegionPointer<2> triangle(const Vec<2>& around, double size) {
  return polygon(
      {around + size * Vec<2>(-0.8, -0.7), around + size * Vec<2>(1.3, -0.5), around + size * Vec<2>(-0.3, 1)});
}
RegionPointer<3> mesh(const Vec<3>& around, const Vec<3>& semi_axes) {
  const TriangleSurface surface = ellipsoid(4, semi_axes);
  Border<3> border{surface.nodes, surface.triangles};
  for (Vec<3>& corner : border.corners) corner += around;
  return std::make_shared<FacetedRegion<3>>(border);
}

}  // namespace

TEST_CASE("forces of walls of any shape on cells are minus the gradient of their energy") {
  const Domain<2> plane({24, 22}, {true, true});
  const Vec<2> here(11.3, 10.2);
  check_gradient<2>("in a disc", plane, ball_region<2>({11.8, 10.5}, 6), here);
  check_gradient<2>("beside a disc", plane, outside_of(ball_region<2>({18.4, 13.1}, 2.7)), here);
  check_gradient<2>("in a triangle", plane, triangle(here, 8.2), here);
  check_gradient<2>("beside a triangle", plane, outside_of(triangle({19, 10}, 2.8)), here);
  check_gradient<2>("in a corner of planes and a disc", {{24, 18}, {true, false}},
                    outside_of(ball_region<2>({17.5, 9}, 2.8)), {11.3, 5.1});
  check_gradient<2>("beside a triangle, periods away", plane, outside_of(triangle({19, 10}, 2.8)), here, -7);
  const Domain<3> space({24, 20, 22}, {true, false, true});
  const Vec<3> there(11.3, 9.2, 10.6);
  check_gradient<3>("in a ball", space, ball_region<3>({11.8, 9.5, 10.7}, 6), there);
  check_gradient<3>("beside a ball", space, outside_of(ball_region<3>({17.4, 12.1, 9}, 2.7)), there);
  check_gradient<3>("in a mesh", space, mesh({11.5, 9.4, 10.5}, {6, 5.8, 6.3}), there);
  check_gradient<3>("beside a mesh", space, outside_of(mesh({18, 10, 10}, {2, 3, 4})), there);
  check_gradient<3>("in the edge of a prism", space, extruded(triangle(Vec<2>(11.3, 9.2), 8.2), 2, -20, 40), there);
  check_gradient<3>("on the end of a prism", space, outside_of(extruded(triangle(Vec<2>(11.3, 9.2), 3), 2, -9, 5.2)),
                    there);
  check_gradient<3>("beside a mesh, periods away", space, outside_of(mesh({18, 10, 10}, {2, 3, 4})), there, 5);
}
