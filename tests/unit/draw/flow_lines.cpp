#include "report/draw/flow_lines.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rouleau::report;

namespace {

constexpr double length = 50e-6, height = 25e-6, rate = 20;

/// Shear between walls, u = rate y, in a periodic box.
BlockVelocity shear() {
  constexpr std::size_t nx = 32, ny = 16;
  BlockVelocity velocity{{0, 0}, {length, height}, {nx, ny, {}}, {nx, ny, std::vector<double>(nx * ny)}, true};
  for (std::size_t j = 0; j < ny; ++j)
    for (std::size_t i = 0; i < nx; ++i) velocity.u.values.push_back(rate * (double(j) + 0.5) / double(ny) * height);
  return velocity;
}

}  // namespace

TEST_CASE("between blocks the velocity is linear, and a whole box away it is the same") {
  const BlockVelocity velocity = shear();
  for (const double y : {0.2, 0.5, 0.77}) {
    CHECK(velocity.at(1e-6, y * height)[0] == Approx(rate * y * height).epsilon(1e-9));
    CHECK(velocity.at(1e-6 + 3 * length, y * height)[0] == Approx(rate * y * height).epsilon(1e-9));
  }
}

TEST_CASE("lines of the flow in shear are level, as long as the speed, and the same for the same instant") {
  const BlockVelocity velocity = shear();
  constexpr double seconds = 0.01;
  const auto lines = flow_lines(velocity, 0.3, seconds);
  REQUIRE(lines.size() > 100);
  double longest = 0;
  for (const FlowLine& line : lines) {
    CHECK(line.points.front()[1] == Approx(line.points.back()[1]).epsilon(1e-12));
    longest = std::max(longest, line.points.back()[0] - line.points.front()[0]);
    CHECK(line.strength >= 0);
    CHECK(line.strength <= 1);
  }
  CHECK(longest < 0.41 * rate * height * seconds);
  CHECK(longest > 0.25 * rate * height * seconds);
  const auto again = flow_lines(velocity, 0.3, seconds);
  for (std::size_t k = 0; k < lines.size(); ++k) CHECK(lines[k].points == again[k].points);
  CHECK(flow_lines(velocity, 0.4, seconds)[0].points != lines[0].points);
}
