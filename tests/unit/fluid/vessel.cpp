// A vessel in a box that is mostly solid: what it takes.
#include <catch2/catch.hpp>

#include "unit/flow_fixture.hpp"
#include "unit/shipped_models.hpp"

using namespace rouleau::core;
using namespace rouleau::test;

TEST_CASE("a vessel at a tenth of its box takes at most 1.15 of the memory of a box with as many nodes", "[fluid]") {
  // A tube across the box at 45 degrees, as a slanted cylinder of nodes.
  const std::array<int, 3> size{112, 112, 112};
  const auto solid = std::make_shared<const SolidNodes<3>>(size, [](const std::array<int, 3>& node) {
    const double across = (node[0] - node[1]) / std::sqrt(2.0), up = node[2] - 55.5;
    return across * across + up * up > 17 * 17;
  });
  const auto nodes = static_cast<double>(solid->fluid_count());
  REQUIRE(nodes < 0.11 * 112 * 112 * 112);
  FluidSetting<3> setting{.domain = {size, {true, true, true}}, .relaxation_rate = 1, .solid = solid};
  const Fluid<float, D3Q19> vessel(setting, trt(1, false, 3));
  // 112 nodes along x, and the others' product as near to the vessel's as it goes.
  const int side = static_cast<int>(std::sqrt(nodes / 112));
  setting.domain = {{112, side, side}, {true, true, true}};
  setting.solid = nullptr;
  const Fluid<float, D3Q19> box(setting, trt(1, false, 3));
  CHECK(static_cast<double>(vessel.bytes()) / nodes < 1.15 * static_cast<double>(box.bytes()) / (112.0 * side * side));
}
