// Motion of the nodes, and the bounds on it that lists rely on.
#include "core/membrane/motion.hpp"

#include <catch2/catch.hpp>

#include "core/membrane/displacement_watch.hpp"
#include "unit/cell_fixture.hpp"

using namespace rouleau;
using namespace rouleau::core;
using namespace rouleau::test;

namespace {

void random_velocity(Membranes& m, std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  for (std::size_t i = 0; i < m.position[0].size(); ++i)
    m.velocity[0][i] = uniform(random), m.velocity[1][i] = uniform(random);
}

}  // namespace

TEST_CASE("nodes move by their velocity and the largest step of each cell is known") {
  auto random = generator(91);
  Membranes m = biconcave_cells({{30, 20, 0}, {60, 40, 0}}, 97);
  m.largest_step.assign(2, 0.0);
  random_velocity(m, random, 0.1);
  m.velocity[0][96] = 0.3;
  m.velocity[1][97 + 50] = -0.4;
  const Membranes before = m;
  run_pass(2, [&](Worker worker) { move_nodes(worker, m); });
  for (std::size_t i = 0; i < m.position[0].size(); ++i) {
    REQUIRE(m.position[0][i] == before.position[0][i] + m.velocity[0][i]);
    REQUIRE(m.position[1][i] == before.position[1][i] + m.velocity[1][i]);
  }
  CHECK(m.largest_step[0] == Approx(std::hypot(0.3, m.velocity[1][96])));
  CHECK(m.largest_step[1] == Approx(std::hypot(0.4, m.velocity[0][97 + 50])));
  CHECK(largest_step(m) == m.largest_step[1]);
  CHECK(farthest_node(m).node == 97 + 50);
}

TEST_CASE("a velocity that is no number shows in the largest step, wherever it is") {
  const double bad = GENERATE(std::nan(""), std::numeric_limits<double>::infinity());
  const std::size_t node = GENERATE(0, 7, 50, 96, 97, 193);
  auto random = generator(92);
  Membranes m = biconcave_cells({{30, 20, 0}, {60, 40, 0}}, 97);
  m.largest_step.assign(2, 0.0);
  random_velocity(m, random, 0.1);
  m.velocity[1][node] = bad;
  move_nodes({}, m);
  CHECK(std::isnan(largest_step(m)));
  CHECK(farthest_node(m).node == static_cast<int>(node));
}

TEST_CASE("a watch never overlooks a displacement beyond its limit, though it seldom compares positions") {
  auto random = generator(93);
  Membranes m = biconcave_cells({{30, 20, 0}, {60, 40, 0}});
  m.largest_step.assign(2, 0.0);
  DisplacementWatch watch(m);
  std::vector<double> x = m.position[0], y = m.position[1];
  int exceeded = 0;
  for (int step = 0; step < 400; ++step) {
    watch.measure({}, m);
    for (int c = 0; c < 2; ++c) {
      const CellRange& cell = m.cells[static_cast<std::size_t>(c)];
      double most = step == 0 ? 1 : 0;  // nothing is remembered before the first step
      for (auto i = static_cast<std::size_t>(cell.first); i < static_cast<std::size_t>(cell.end()); ++i) {
        if (step > 0) most = std::max(most, std::hypot(m.position[0][i] - x[i], m.position[1][i] - y[i]));
      }
      REQUIRE(watch.moved(c) == most > 0.2);
      if (!watch.moved(c)) continue;
      ++exceeded;
      watch.remember(c, m, 0.2);
      for (auto i = static_cast<std::size_t>(cell.first); i < static_cast<std::size_t>(cell.end()); ++i) {
        x[i] = m.position[0][i], y[i] = m.position[1][i];
      }
    }
    random_velocity(m, random, 0.02);
    move_nodes({}, m);
  }
  CHECK(exceeded > 4);
  CHECK(exceeded < 200);
}
