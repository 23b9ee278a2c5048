// Which cells ranks know of each other, and which they can do without each other.
#include "core/solver/ghost_cells.hpp"

#include <catch2/catch.hpp>

namespace rouleau::core {

namespace {

constexpr double half = 4;  // of a cell's box
constexpr GhostReach reach{.lattice = 8, .contact = 0};

BoundingBox<2> around(double x, double y) { return {{x - half, y - half}, {x + half, y + half}}; }

/// Whether a cell there lies inside of the first of two blocks.
bool inside(const Decomposition<2>& blocks, double x, double y) {
  const auto ends = make_loopback(blocks.ranks());
  return GhostCells<2>(Ranks<2>{&blocks, ends[0].get()}, {around(x, y)}, reach).inside(0);
}

}  // namespace

TEST_CASE("a cell lies inside of a block where it comes near neither another block nor a wall") {
  const double room = half + reach.lattice + GhostCells<2>::skin;
  const Domain<2> channel({80, 96}, {true, false});
  const auto beside = Decomposition<2>::even(channel, {2, 1});  // the first block: x up to 39
  CHECK(inside(beside, 20, 48));
  CHECK(inside(beside, 20 + 3 * 80, 48));  // places are not wrapped
  CHECK(inside(beside, room + 0.1, 48));
  CHECK_FALSE(inside(beside, room - 0.1, 48));
  CHECK_FALSE(inside(beside, 39 - room + 1, 48));
  CHECK_FALSE(inside(beside, 60, 48));  // the other's
  CHECK_FALSE(inside(beside, 20, room - 0.1));
  CHECK(inside(beside, 20, room));
  CHECK_FALSE(inside(beside, 20, 95 - room + 0.1));
  CHECK_FALSE(inside(beside, std::nan(""), 48));
  // A block that reaches around is its own neighbour there.
  const auto above = Decomposition<2>::even(channel, {1, 2});
  CHECK(inside(above, 0, 24));
  CHECK(inside(above, 79, 24));
  CHECK_FALSE(inside(above, 0, 47));
}

}  // namespace rouleau::core
