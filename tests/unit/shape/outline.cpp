// Outlines of the shapes and the geometry read off them.
#include "shape/outline.hpp"
#include "plan/placed_cells.hpp"

#include <catch2/catch.hpp>

#include "core/membrane/geometry.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::plan;
using namespace rouleau::scene;
using namespace rouleau::shape;
using namespace rouleau::test;

namespace {

Membranes membranes_of(const Outline& outline) {
  Membranes m;
  for (const auto& node : outline.nodes) {
    m.position[0].push_back(node.x());
    m.position[1].push_back(node.y());
  }
  m.cells.push_back({{0, m.node_count()}, 0, 0, 0});
  return m;
}

/// Scene of biconcave cells of one type (radius 20, spacing 1) in lattice coordinates.
inline Scene biconcave_scene(const std::vector<Placed>& places, core::Domain<2> domain, int height,
                             int segments = 100) {
  Scene scene{};
  scene.domain.nodes = {static_cast<int>(domain.period(0)),
                        domain.periodic[1] ? static_cast<int>(domain.period(1)) : height};
  scene.domain.size = {domain.period(0), static_cast<double>(scene.domain.nodes[1])};
  scene.domain.periodic[1] = domain.periodic[1];
  scene.cell_types.push_back({"red", Biconcave{20.0}, segments, 1.0, {}});
  for (std::size_t i = 0; i < places.size(); ++i) {
    scene.cells.push_back({0, {places[i].x + 0.5, places[i].y + 0.5}, places[i].angle, "/cells/" + std::to_string(i)});
  }
  return scene;
}

// Of Evans and Fung's curve (core/surface/triangle_surface.hpp) with R = 3.91 um, integrated.
constexpr double exact_perimeter = 19.27042, exact_area = 13.62222;  // um, um2

}  // namespace

TEST_CASE("all segments of an outline are equally long") {
  const Shape shape = GENERATE(Shape{Biconcave{3.91e-6}}, Shape{Circle{4e-6, 1.0}}, Shape{Ellipse{{4e-6, 1e-6}}},
                               Shape{Ellipse{{1e-6, 3e-6}}});
  const int segments = GENERATE(8, 33, 100, 256);
  const Outline outline = make_outline(shape, segments);
  REQUIRE(outline.nodes.size() == static_cast<std::size_t>(segments));
  double shortest = 1, longest = 0;
  for (std::size_t i = 0; i < outline.nodes.size(); ++i) {
    const double length = (outline.nodes[(i + 1) % outline.nodes.size()] - outline.nodes[i]).norm();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  CHECK(longest / shortest - 1 < 1e-12);
  CHECK(outline.nodes[0].y() == 0);
  CHECK(outline.nodes[0].x() > 0);
  const Membranes m = membranes_of(outline);
  CHECK(enclosed_area(m, m.cells[0]) > 0);
}

TEST_CASE("the biconcave outline has the perimeter and area of the curve, to second order in the segments") {
  double perimeter_error[2], area_error[2];
  for (int k = 0; k < 2; ++k) {
    const Membranes m = membranes_of(make_outline(Biconcave{3.91}, k == 0 ? 200 : 400));
    perimeter_error[k] = exact_perimeter - perimeter(m, m.cells[0]);
    area_error[k] = exact_area - enclosed_area(m, m.cells[0]);
  }
  // Second order: 4, within what the five decimals of the reference leave.
  CHECK(perimeter_error[0] / perimeter_error[1] == Approx(4).epsilon(0.05));
  CHECK(area_error[0] / area_error[1] == Approx(4).epsilon(0.05));
  // Richardson: the error that is left after extrapolation is that of the reference.
  CHECK(perimeter_error[1] - (perimeter_error[0] - perimeter_error[1]) / 3 == Approx(0).margin(1e-5));
  CHECK(area_error[1] - (area_error[0] - area_error[1]) / 3 == Approx(0).margin(1e-5));
}

TEST_CASE("two biconcave cells 3.52 um apart have a rim gap of 0.95503 um") {
  // By symmetry the rims come closest straight above each other; the polygon's gap is larger by its second-order
  // defect.
  const Outline outline = make_outline(Biconcave{3.91}, 2000);
  Membranes m;
  for (const double y : {0.0, 3.52}) {
    m.cells.push_back({{m.node_count(), 2000}, 0, 0, 0});
    for (const auto& node : outline.nodes) {
      m.position[0].push_back(node.x());
      m.position[1].push_back(node.y() + y);
    }
  }
  CHECK(smallest_gap(m, 0, 1, periodic_box(1000), 2.0) == Approx(0.95503).margin(1e-5));
  CHECK(std::isinf(smallest_gap(m, 0, 1, periodic_box(1000), 0.95)));
}

TEST_CASE("the gap of two cells is that of the nearest periodic images") {
  const Membranes m = biconcave_cells({{10, 0, 0.3}, {10 + 3 * 128 - 60, 5, -0.4}});
  const Membranes near = biconcave_cells({{10, 0, 0.3}, {10 - 60, 5, -0.4}});
  CHECK(smallest_gap(m, 0, 1, periodic_box(128), 40) ==
        Approx(smallest_gap(near, 0, 1, periodic_box(1000000), 40)).epsilon(1e-12));
  // A cell's own images in a box that is hardly longer than the cell.
  const Membranes one = biconcave_cells({{0, 0, 0}});
  CHECK(smallest_gap(one, 0, 0, periodic_box(42), 10) == Approx(2.0).epsilon(1e-12));
}

TEST_CASE("the inertia ellipse of an elliptic outline is the ellipse") {
  const double angle = GENERATE(-1.2, 0.0, 0.7);
  Membranes m = membranes_of(make_outline(Ellipse{{3.0, 1.0}}, 1000));
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    const double x = m.position[0][i], y = m.position[1][i];
    m.position[0][i] = 100 + std::cos(angle) * x - std::sin(angle) * y;
    m.position[1][i] = -50 + std::sin(angle) * x + std::cos(angle) * y;
  }
  const InertiaEllipse ellipse = inertia_ellipse(m, m.cells[0]);
  CHECK(ellipse.semi_major == Approx(3).epsilon(1e-5));  // the polygon is inscribed: second order
  CHECK(ellipse.semi_minor == Approx(1).epsilon(1e-5));
  CHECK(ellipse.deformation == Approx(0.5).epsilon(1e-5));
  CHECK(ellipse.angle == Approx(angle).margin(1e-9));
  CHECK(marker_angle(m, m.cells[0]) == Approx(angle).margin(1e-9));
  CHECK(centroid(m, m.cells[0]).x() == Approx(100).epsilon(1e-9));
}

TEST_CASE("a scene's cells lie in lattice units half a spacing from the domain's edge") {
  const double spacing = 0.1955e-6;
  Scene scene{};
  scene.domain.nodes = {256, 128};
  scene.domain.size = {256 * spacing, 128 * spacing};
  scene.cell_types.push_back({"ring", Circle{2e-6, 1.25}, 64, 1e-3, {}});
  scene.cells.push_back({0, {10e-6, 8e-6}, 0.5, "/cells/0"});
  const Membranes m = make_cells<2>(scene, spacing);
  CHECK(centroid(m, m.cells[0]).x() == Approx(10e-6 / spacing - 0.5));
  CHECK(centroid(m, m.cells[0]).y() == Approx(8e-6 / spacing - 0.5));
  CHECK(marker_angle(m, m.cells[0]) == Approx(0.5));
  CHECK(perimeter(m, m.cells[0]) / m.cells[0].rest_perimeter == Approx(1.25));
  CHECK(enclosed_area(m, m.cells[0]) / m.cells[0].rest_area == Approx(1));
}

TEST_CASE("cells that cannot be placed are refused with both places and the amount") {
  const auto refused = [](const Scene& scene) {
    try {
      make_cells<2>(scene, 1e-6);
    } catch (const Error& error) {
      CHECK(error.cause() == Cause::bad_input);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto scene_of = [](const std::vector<Placed>& places, core::Domain<2> domain, int height) {
    Scene scene = biconcave_scene(places, domain, height);
    scene.cell_types[0].shape = Circle{20e-6, 1.0};
    for (CellPlacement& cell : scene.cells) cell.center *= 1e-6;
    return scene;
  };
  using Catch::Contains;
  CHECK(refused(scene_of({{50, 50}, {95, 50}}, periodic_box(256), 100)) == "accepted");
  CHECK_THAT(refused(scene_of({{50, 50}, {85, 50}}, periodic_box(256), 100)),
             Contains("/cells/0") && Contains("/cells/1") && Contains("overlap by 5 um"));
  CHECK_THAT(refused(scene_of({{10, 50}, {241, 50}}, periodic_box(256), 100)),
             Contains("periodic image") && Contains("um"));
  CHECK_THAT(refused(scene_of({{50, 17}}, periodic_box(256), 100)), Contains("lower wall across y by 2.5 um"));
  CHECK_THAT(refused(scene_of({{50, 82}}, periodic_box(256), 100)), Contains("upper wall across y by 2.5 um"));
  CHECK(refused(scene_of({{50, 17}}, periodic_box(256, 100), 100)) == "accepted");
  CHECK_THAT(refused(scene_of({{50, 10}, {50, 85}}, periodic_box(256, 100), 100)), Contains("periodic image"));
  CHECK_THAT(refused(scene_of({{50, 50}}, periodic_box(39), 100)), Contains("periodic length"));
  CHECK_THAT(refused(scene_of({{50, 50}}, periodic_box(256, 39), 39)), Contains("long along y"));
  Scene inside = scene_of({{50, 50}, {50, 50}}, periodic_box(256), 100);
  inside.cell_types.push_back({"small", Circle{5e-6, 1.0}, 30, 1.0, {}});
  inside.cells[0].type = 1;
  CHECK_THAT(refused(inside), Contains("overlap by"));
}
