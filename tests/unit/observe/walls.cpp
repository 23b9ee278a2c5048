// Cells beside walls of any shape: gaps, layers, areas of walls and fluxes, against what they are by formula.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/contact/wall_gap.hpp"
#include "core/geometry/border.hpp"
#include "core/geometry/formulas.hpp"
#include "core/surface/triangle_surface.hpp"
#include "observe/cell_free_layer.hpp"
#include "observe/rheology.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::observe;

namespace {

constexpr double pi = std::numbers::pi;

Membranes discs(double radius, const std::vector<Vec<2>>& centres, int segments = 240) {
  std::vector<double> x, y;
  for (int i = 0; i < segments; ++i) {
    x.push_back(radius * std::cos(2 * pi * i / segments));
    y.push_back(radius * std::sin(2 * pi * i / segments));
  }
  Membranes m;
  m.types.push_back(std::make_shared<const RestShape>(make_rest_shape(std::move(x), std::move(y))));
  for (const Vec<2>& centre : centres) add_cell(m, 0, centre.x(), centre.y(), 0);
  return m;
}

Surfaces balls(double radius, const std::vector<Vec<3>>& centres, int frequency = 12) {
  Surfaces surfaces;
  surfaces.types.push_back(
      std::make_shared<const RestSurface>(rest_surface(ellipsoid(frequency, Vec<3>::Constant(radius)))));
  for (const Vec<3>& centre : centres) add_cell(surfaces, 0, centre);
  return surfaces;
}

/// Gives the nodes of all cells a velocity by their place.
template <int D, class Cells, class Velocity>
void set_velocity(Cells& cells, Velocity velocity) {
  for (int i = 0; i < cells.node_count(); ++i) {
    Vec<D> place;
    for (int k = 0; k < D; ++k) place[k] = cells.position[k][i];
    const Vec<D> at = velocity(place);
    for (int k = 0; k < D; ++k) cells.velocity[k][i] = at[k];
  }
}

const Domain<2> plane({80, 80}, {true, false});
const Domain<3> space({40, 40, 40}, {true, false, false});

}  // namespace

TEST_CASE("the gap of a cell in a vessel is that of its nearest node, and the plane walls' where these are nearer") {
  const Vec<2> middle(40, 39.5);
  const auto vessel = intersection<2>({ball_region<2>(middle, 35), outside_of<2>(ball_region<2>({25, 39.5}, 4))});
  // A node lies in the direction of the wall: of 240, at every 1.5 degrees.
  const Membranes m = discs(6, {{60, 39.5}, {36, 39.5}, {40, 39.5 + 32}, {40, 6}});
  CHECK(wall_gap(m, m.cells[0], plane, vessel.get()) == Approx(35 - 20 - 6).epsilon(1e-12));
  CHECK(wall_gap(m, m.cells[1], plane, vessel.get()) == Approx(11 - 6 - 4).epsilon(1e-12));
  CHECK(wall_gap(m, m.cells[2], plane, vessel.get()) == Approx(-3).epsilon(1e-12));
  CHECK(wall_gap(m, m.cells[3], plane, ball_region<2>(middle, 1000).get()) == Approx(0.5).epsilon(1e-12));
  CHECK(wall_gap(m, m.cells[3], Domain<2>({80, 80}, {true, true}), vessel.get()) == Approx(-4.5).epsilon(1e-12));
  // In space, against all nodes of a cell beside a wall.
  const Surfaces s = balls(5, {{22, 12, 17}});
  const auto tube = extruded(ball_region<2>({19.5, 19.5}, 18), 0, -INFINITY, INFINITY);
  double least = 1e9;
  for (int i = 0; i < s.node_count(); ++i)
    least = std::min(least, 18 - std::hypot(s.position[1][i] - 19.5, s.position[2][i] - 19.5));
  CHECK(wall_gap(s, s.cells[0], space, tube.get()) == Approx(least).epsilon(1e-13));
}

TEST_CASE("the border of a region is as long or as large as it is, to second order") {
  const auto circle = [](double radius, int nodes) {
    const auto region = ball_region<2>({0.47 * nodes, 0.51 * nodes}, radius);
    return size_of<2>(border_of_region(*region, Domain<2>({nodes, nodes}, {true, false}))) / (2 * pi * radius) - 1;
  };
  CHECK(std::abs(circle(17.3, 50)) < 1e-3);
  CHECK(std::abs(circle(69.2, 200)) < 1e-3 / 12);
  const auto ball = ball_region<3>({19.2, 20.1, 18.7}, 15.4);
  CHECK(size_of<3>(border_of_region(*ball, space)) == Approx(4 * pi * 15.4 * 15.4).epsilon(2e-3));
  const auto tube = extruded(ball_region<2>({19.5, 19.5}, 18), 0, -INFINITY, INFINITY);
  CHECK(size_of<3>(border_of_region(*tube, space)) == Approx(2 * pi * 18 * 40).epsilon(2e-3));
  // Between plane walls, these and what a post through both of them leaves: edges are cut off, to first order.
  const auto slit = [](int n) {
    const Domain<3> domain({40 * n, 40 * n, 10 * n}, {true, true, false});
    const auto post = outside_of<3>(extruded(ball_region<2>({20.0 * n, 20.0 * n}, 9.0 * n), 2, -INFINITY, INFINITY));
    const auto open = intersection<3>({post, between_walls<3>(domain)});
    const double exact = n * n * (2 * (40 * 40 - pi * 81) + 2 * pi * 9 * 10);
    return size_of<3>(border_of_region(*open, domain)) / exact - 1;
  };
  CHECK(std::abs(slit(1)) < 0.01);
  CHECK(std::abs(slit(2)) < 0.55 * std::abs(slit(1)));
  CHECK(border_of_region(*ball_region<2>({300, 0}, 3), plane).facets.empty());
}

TEST_CASE("the layer without cells at walls of any shape is the mean distance to the nearest membrane") {
  const Vec<2> middle(40, 39.5);
  const auto vessel = wall_points<2>(ball_region<2>(middle, 30), plane);
  // One disc in the middle: as far away from everywhere.
  const CellFreeLayer round = cell_free_layer_at(vessel, discs(21, {middle}), plane);
  CHECK(round.lower == Approx(9).epsilon(2e-3));
  CHECK(round.upper == round.lower);
  CHECK(round.empty == 0);
  // Half way to the other side where a cell is not nearer: no cells, or a small one in the middle.
  CHECK(cell_free_layer_at(vessel, discs(1, {}), plane).lower == Approx(30).epsilon(0.03));
  CHECK(cell_free_layer_at(vessel, discs(1, {}), plane).empty == 1);
  // Off the middle by e the disc of radius r is nearest at sqrt(R^2 + e^2 - 2 R e cos) - r.
  double exact = 0;
  for (int i = 0; i < 3600; ++i) exact += std::sqrt(900 + 49 - 420 * std::cos(2 * pi * (i + 0.5) / 3600)) - 15;
  exact /= 3600;
  const CellFreeLayer off = cell_free_layer_at(vessel, discs(15, {{47, 39.5}}), plane);
  CHECK(off.lower == Approx(exact).epsilon(5e-3));
  // The same through a periodic border.
  const Domain<2> around({80, 80}, {true, true});
  const auto image = repeated<2>(ball_region<2>({0, 39.5}, 30), {0, 39.5}, around);
  const CellFreeLayer cut = cell_free_layer_at(wall_points<2>(image, around), discs(15, {{167, 39.5}}), around);
  CHECK(cut.lower == Approx(exact).epsilon(5e-3));
  // A ball in a ball.
  const auto shell = wall_points<3>(ball_region<3>({19.5, 19.5, 19.5}, 17), space);
  CHECK(cell_free_layer_at(shell, balls(12, {{19.5, 19.5, 19.5}}), space).lower == Approx(5).epsilon(0.01));
}

TEST_CASE("the flux of cells is the integral of the velocity over what they enclose") {
  Membranes m = discs(8, {{13, 31}});
  const double area = 120 * 64 * std::sin(2 * pi / 240);  // of the polygon
  set_velocity<2>(m, [](const Vec<2>&) { return Vec<2>(0.02, -0.01); });
  CHECK(cell_flux(m) == Approx(0.02 * area).epsilon(1e-12));
  set_velocity<2>(m, [](const Vec<2>& at) { return Vec<2>(-0.01 * (at.y() - 31), 0.01 * (at.x() - 13)); });
  CHECK(std::abs(cell_flux(m)) < 1e-14 * area);
  set_velocity<2>(m, [](const Vec<2>& at) { return Vec<2>(0.001 * at.y(), 0); });
  CHECK(cell_flux(m) == Approx(0.001 * 31 * area).epsilon(1e-12));
  // Of u = 1 - (y/H)^2 over a disc: its area times 1 - (y^2 + r^2/4)/H^2.
  set_velocity<2>(m, [](const Vec<2>& at) { return Vec<2>(1 - std::pow(at.y() / 60, 2), 0); });
  CHECK(cell_flux(m) == Approx(pi * 64 * (1 - (31 * 31 + 16) / 3600.0)).epsilon(1e-3));

  Surfaces s = balls(6, {{30, 11, 14}, {5, 20, 20}});
  double volume = 0;
  for (int c = 0; c < 2; ++c) volume += enclosed_volume(s.type_of(c).mesh, s.nodes(c));
  set_velocity<3>(s, [](const Vec<3>&) { return Vec<3>(0.02, 0.03, -0.01); });
  CHECK(cell_flux(s) == Approx(0.02 * volume).epsilon(1e-12));
  set_velocity<3>(s, [](const Vec<3>& at) { return Vec<3>(0.001 * at.z(), 0, 0); });
  CHECK(cell_flux(s) == Approx(0.001 * (14 + 20) * volume / 2).epsilon(1e-10));
}

TEST_CASE("a cell on the axis carries more of the flow than its share of a channel, one at the wall less") {
  // A known flow, u = 1 - (y/H)^2, of mean 2/3, carries discs along: Fahraeus' effect by formula.
  const double half = 20, length = 80, radius = 8;
  const auto discharge = [&](double y) {
    Membranes m = discs(radius, {{30, y}});
    set_velocity<2>(m, [&](const Vec<2>& at) { return Vec<2>(1 - std::pow(at.y() / half, 2), 0); });
    return cell_flux(m) / (2 * half * length * 2 / 3);
  };
  const double tube = pi * radius * radius / (2 * half * length);
  CHECK(discharge(0) == Approx(1.5 * (1 - radius * radius / 4 / (half * half)) * tube).epsilon(1e-3));
  CHECK(discharge(0) > 1.4 * tube);
  CHECK(discharge(11.9) ==
        Approx(1.5 * (1 - (11.9 * 11.9 + radius * radius / 4) / (half * half)) * tube).epsilon(1e-3));
  CHECK(discharge(11.9) < tube);
}

TEST_CASE("openings across a vessel are no walls: the layer beside a cell is that of a periodic vessel") {
  const RegionPointer<2> channel = box_region<2>({-1e3, 8.3}, {1e3, 51.7});
  CellFreeLayer found[2];
  double length[2]{}, widest[2]{};
  for (const bool periodic : {false, true}) {
    const Domain<2> domain({80, 60}, {periodic, false});
    const auto points = wall_points<2>(channel, domain);
    for (const WallPoint<2>& point : points) {
      length[periodic] += point.size;
      widest[periodic] = std::max(widest[periodic], point.half_width);
    }
    found[periodic] = cell_free_layer_at(points, discs(12, {{40, 30}}), domain);
  }
  // A channel of straight walls, whose corners are cut by half a spacing at most.
  CHECK(length[true] == Approx(160).margin(0.1));
  CHECK(length[false] == Approx(160).margin(4));
  CHECK(widest[false] == Approx(21.7).margin(0.5));
  CHECK(widest[true] == Approx(21.7).margin(0.5));
  CHECK(found[false].lower == Approx(found[true].lower).epsilon(0.02));
}
