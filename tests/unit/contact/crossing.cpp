// Crossing membranes are found, touching and separate ones are not.
#include "core/contact/crossing.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "core/membrane/geometry.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

namespace {

Membranes polygons(const std::vector<std::vector<std::pair<double, double>>>& outlines) {
  Membranes m;
  for (const auto& outline : outlines) {
    m.cells.push_back({{m.node_count(), static_cast<int>(outline.size())}, 0, 0, 0});
    for (const auto& [x, y] : outline) m.position[0].push_back(x), m.position[1].push_back(y);
  }
  return m;
}

const auto wide = periodic_box(1000);

}  // namespace

TEST_CASE("cells apart, and cells that touch from outside, do not cross") {
  CHECK_FALSE(find_crossing(biconcave_cells({{0, 0, 0.3}, {0, 30, 1.0}, {60, 5, 2.0}}), wide));
  CHECK_FALSE(find_crossing(polygons({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {{2, 0}, {4, 0}, {4, 2}, {2, 2}}}), wide));
  CHECK_FALSE(find_crossing(polygons({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {{2, 1}, {4, 0}, {4, 2}}}), wide));
}

TEST_CASE("two overlapping cells cross, and the place is on both outlines") {
  const Membranes m = biconcave_cells({{0, 0, 0.0}, {1, 11, 0.1}});
  const auto crossing = find_crossing(m, wide);
  REQUIRE(crossing);
  CHECK(crossing->cell == 0);
  CHECK(crossing->other == 1);
  CHECK_FALSE(crossing->inside);
  CHECK(std::abs(depth_inside(m, m.cells[0], crossing->place)) < 1e-12);
  CHECK(std::abs(depth_inside(m, m.cells[1], crossing->place)) < 1e-12);
}

TEST_CASE("a cell that crosses a periodic image of another, or its own, is found") {
  const Membranes pair = biconcave_cells({{0, 0, 0.0}, {300 - 35, 1, 0.1}});
  CHECK_FALSE(find_crossing(pair, wide));
  const auto crossing = find_crossing(pair, periodic_box(100));
  REQUIRE(crossing);
  CHECK(crossing->shift == ImageShift{-3, 0});
  const Membranes one = biconcave_cells({{0, 0, 0.0}});
  CHECK_FALSE(find_crossing(one, periodic_box(41)));
  const auto own = find_crossing(one, periodic_box(39));
  REQUIRE(own);
  CHECK(own->other == 0);
  CHECK_FALSE(own->shift == ImageShift{});
  CHECK_FALSE(find_crossing(one, periodic_box(1000, 14)));
  CHECK(find_crossing(one, periodic_box(1000, 12)));
}

TEST_CASE("a cell that crosses itself is found, and a fold that only touches is not") {
  const auto crossing = find_crossing(polygons({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}}), wide);
  REQUIRE(crossing);
  CHECK(crossing->cell == crossing->other);
  CHECK(crossing->place.x() == Approx(2));
  CHECK(crossing->place.y() == Approx(2));
  Membranes m = biconcave_cells({{0, 0, 0.4}});
  CHECK_FALSE(find_crossing(m, wide));
  std::swap(m.position[0][50], m.position[0][51]), std::swap(m.position[1][50], m.position[1][51]);
  CHECK(find_crossing(m, wide));
}

TEST_CASE("a crossing through a node is found") {
  // The lower corner of the second lies below the first's upper edge, its sides pass through nodes of that edge.
  CHECK(find_crossing(polygons({{{0, 0}, {4, 0}, {4, 2}, {3, 2}, {1, 2}, {0, 2}}, {{2, 1}, {4, 3}, {0, 3}}}), wide));
}

TEST_CASE("a cell inside another is found from either side") {
  const std::vector<std::pair<double, double>> large = {{0, 0}, {10, 0}, {10, 10}, {0, 10}},
                                               small = {{4, 4}, {5, 4}, {5, 5}};
  for (const auto& m : {polygons({large, small}), polygons({small, large})}) {
    const auto crossing = find_crossing(m, wide);
    REQUIRE(crossing);
    CHECK(crossing->inside);
    CHECK(m.cells[static_cast<std::size_t>(crossing->cell)].count == 3);
  }
  // In the hollow of a concave cell, within its bounds but outside.
  CHECK_FALSE(
      find_crossing(polygons({{{0, 0}, {10, 0}, {10, 10}, {5, 1}, {0, 10}}, {{4.8, 7}, {5.2, 7}, {5, 7.5}}}), wide));
}

TEST_CASE("crossings are found as by testing every pair of segments") {
  auto random = generator(91);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int crossing_scenes = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Membranes m = biconcave_cells(
        {{0, 0, 3 * uniform(random)}, {30 * uniform(random), 30 * uniform(random), 3 * uniform(random)}}, 60);
    deform(m, random, 3);
    bool brute = false;
    const auto side = [&](int a, int b, int p) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b), k = static_cast<std::size_t>(p);
      return (m.position[0][j] - m.position[0][i]) * (m.position[1][k] - m.position[1][i]) -
                 (m.position[1][j] - m.position[1][i]) * (m.position[0][k] - m.position[0][i]) >
             0;
    };
    const auto next = [&](int i) { return m.cells[i < 60 ? 0 : 1].next(i); };
    for (int i = 0; i < 120; ++i) {
      for (int j = i + 1; j < 120; ++j) {
        if (j == next(i) || i == next(j)) continue;
        brute |= side(i, next(i), j) != side(i, next(i), next(j)) && side(j, next(j), i) != side(j, next(j), next(i));
      }
    }
    REQUIRE(find_crossing(m, periodic_box(100000)).has_value() == brute);
    crossing_scenes += brute ? 1 : 0;
  }
  CHECK(crossing_scenes > 50);
  CHECK(crossing_scenes < 250);
}

TEST_CASE("positions that are not numbers are no crossing and no crash") {
  Membranes m = biconcave_cells({{0, 0, 0.0}, {0, 20, 0.1}});
  m.position[0][5] = std::nan("");
  m.position[1][150] = std::numeric_limits<double>::infinity();
  CHECK_FALSE(find_crossing(m, periodic_box(50, 50)));
}

TEST_CASE("of several crossings the one of the first cells is found, wherever they lie among thousands") {
  std::vector<std::vector<std::pair<double, double>>> squares;
  for (int row = 0; row < 100; ++row) {
    for (int column = 0; column < 100; ++column) {
      const double x = 6.0 * column, y = 6.0 * row;
      squares.push_back({{x, y}, {x + 4, y}, {x + 4, y + 4}, {x, y + 4}});
    }
  }
  CHECK_FALSE(find_crossing(polygons(squares), periodic_box(600, 600)));
  for (const std::size_t moved : {9876, 4321, 1234}) {
    for (auto& [x, y] : squares[moved]) x += 3;
  }
  const auto crossing = find_crossing(polygons(squares), periodic_box(600, 600));
  REQUIRE(crossing);
  CHECK(crossing->cell == 1234);
  CHECK(crossing->other == 1235);
}
