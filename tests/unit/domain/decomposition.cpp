#include "core/domain/decomposition.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "unit/random.hpp"

namespace rouleau::core {
namespace {

using Points = std::vector<std::array<int, 2>>;

/// Of the most expensive block over the mean.
double imbalance(const Decomposition<2>& blocks, const Points& points, double point_cost) {
  std::vector<double> costs;
  double sum = 0;
  for (int rank = 0; rank < blocks.ranks(); ++rank) {
    const Box<2> box = blocks.domain(rank).block;
    double cost = static_cast<double>(box.size(0)) * box.size(1);
    for (const auto& point : points) cost += box.contains(point) ? point_cost : 0;
    costs.push_back(cost);
    sum += cost;
  }
  return *std::max_element(costs.begin(), costs.end()) / (sum / blocks.ranks());
}

}  // namespace

TEST_CASE("an empty lattice is cut into equal blocks, whose number is a power of two") {
  const Domain<2> domain({256, 128}, {true, false});
  for (const int ranks : {1, 2, 4, 8, 16}) {
    const auto blocks = Decomposition<2>::bisected(domain, ranks);
    CHECK(blocks.ranks() == ranks);
    CHECK(imbalance(blocks, {}, 0) == 1);
  }
}

TEST_CASE("blocks that have to hold the same cost do, within the columns and rows that a cut can choose") {
  auto random = test::generator(static_cast<unsigned>(std::random_device()()));
  const Domain<2> domain({512, 384}, {true, false});
  Points points;  // twice as many in the left half and in the lower one
  std::uniform_int_distribution<int> left(0, 255), right(256, 511), low(0, 191), high(192, 383);
  for (int i = 0; i < 3000; ++i)
    points.push_back({i % 3 == 0 ? right(random) : left(random), i / 3 % 3 == 0 ? high(random) : low(random)});
  const double point_cost = 200;
  for (const int ranks : {2, 3, 5, 8, 12}) {
    CAPTURE(ranks);
    const auto blocks = Decomposition<2>::bisected(domain, ranks, points, point_cost);
    // A cut errs by up to 8 columns of 4/3 of the mean cost, of blocks at least 128 wide, and two cuts add up.
    const double bound = 1.2;
    CHECK(imbalance(blocks, points, point_cost) < bound);
    CHECK(imbalance(Decomposition<2>::bisected(domain, ranks), points, point_cost) > bound);  // blind to points
  }
}

TEST_CASE("blocks that were measured to be slow become smaller") {
  // The lower block computes at a third of the upper one's pace.
  const Domain<2> domain({512, 384}, {true, false});
  const auto blocks = Decomposition<2>::bisected(domain, 2);
  const auto again = Decomposition<2>::bisected(domain, 2, {}, 0, {.blocks = &blocks, .factor = {3, 1}});
  // 3 of 4 parts of the cost lie in the lower half, of which the lower block keeps two thirds.
  CHECK(std::abs(again.domain(0).block.size(1) - 384.0 / 3) <= 1);
  // A point costs there what it does elsewhere times the factor.
  Points points(100, {500, 7});
  const auto heavy = Decomposition<2>::bisected(domain, 2, points, 512, {.blocks = &blocks, .factor = {1, 1}});
  CHECK(heavy.domain(0).block.size(1) == (384 + 100) / 2 - 100);
}

TEST_CASE("cuts go where the border costs least") {
  // Numbers beside each other in memory cost little: along rows, unless the lattice is three times as wide as it is
  // high, or ten times where blocks are larger than a cache.
  CHECK(Decomposition<2>::bisected(Domain<2>({320, 128}, {true, false}), 2).domain(0).block.size(1) == 64);
  CHECK(Decomposition<2>::bisected(Domain<2>({512, 128}, {true, false}), 2).domain(0).block.size(0) == 256);
  CHECK(Decomposition<2>::bisected(Domain<2>({4096, 512}, {true, false}), 2).domain(0).block.size(1) == 256);
  CHECK(Decomposition<3>::bisected(Domain<3>({64, 64, 64}, {true, true, true}), 2).domain(0).block.size(2) == 32);
  // Many points near it cost as much across any axis, so that the shorter border is the better one.
  Points points;
  for (int i = 0; i < 10000; ++i) points.push_back({i % 320, i * 7 % 128});
  CHECK(Decomposition<2>::bisected(Domain<2>({320, 128}, {true, false}), 2, points, 30).domain(0).block.size(0) == 160);
}

TEST_CASE("cuts along rows of memory lie at multiples of 16 nodes where there is room for them") {
  const auto blocks = Decomposition<2>::bisected(Domain<2>({200, 40}, {true, true}), 5);
  for (int rank = 0; rank < 5; ++rank) CHECK(blocks.domain(rank).block.begin[0] % 16 == 0);
  CHECK(Decomposition<2>::bisected(Domain<2>({20, 4}, {true, true}), 2).ranks() == 2);
}

TEST_CASE("random lattices are cut into as many blocks as wanted, and refused where there is no room") {
  auto random = test::generator(static_cast<unsigned>(std::random_device()()));
  for (int trial = 0; trial < 200; ++trial) {
    const int nx = std::uniform_int_distribution<int>(1, 90)(random),
              ny = std::uniform_int_distribution<int>(1, 90)(random);
    const Domain<2> domain({nx, ny}, {true, false});
    Points points;
    for (int i = 0; i < 50; ++i) points.push_back({i * i % nx, i % ny});
    const int most = nx * ny / static_cast<int>(Decomposition<2>::least_nodes);
    const int ranks = std::uniform_int_distribution<int>(1, std::max(1, most))(random);
    CAPTURE(nx, ny, ranks);
    if (ranks <= most) CHECK(Decomposition<2>::bisected(domain, ranks, points, 30).ranks() == ranks);  // or it throws
    CHECK_THROWS_AS(Decomposition<2>::bisected(domain, most + 1, points, 30), std::invalid_argument);
  }
}

TEST_CASE("blocks are found by place as by looking at all of them") {
  auto random = test::generator(static_cast<unsigned>(std::random_device()()));
  const auto number = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); };
  for (int trial = 0; trial < 200; ++trial) {
    const Domain<2> domain({number(8, 90), number(8, 90)}, {true, false});
    Points points;
    for (int i = 0; i < 50; ++i) points.push_back({number(0, domain.size[0] / 3), number(0, domain.size[1] - 1)});
    const auto blocks =
        trial % 2 == 0 ? Decomposition<2>::bisected(domain, number(1, static_cast<int>(domain.nodes() / 16)), points, 9)
                       : Decomposition<2>::even(domain, {number(1, domain.size[0]), number(1, domain.size[1])});
    for (int look = 0; look < 20; ++look) {
      const std::array<int, 2> node{number(0, domain.size[0] - 1), number(0, domain.size[1] - 1)};
      REQUIRE(blocks.domain(blocks.owner(node)).block.contains(node));
      const Box<2> box{{number(-9, 95), number(-9, 95)}, {number(-9, 99), number(-9, 99)}};
      std::vector<int> met;
      for (int rank = 0; rank < blocks.ranks(); ++rank) {
        const Box<2> block = blocks.domain(rank).block;
        bool meets = true;
        for (int k = 0; k < 2; ++k)
          meets = meets && std::max(block.begin[k], box.begin[k]) < std::min(block.end[k], box.end[k]);
        if (meets) met.push_back(rank);
      }
      REQUIRE(blocks.meeting(box) == met);
    }
  }
}

}  // namespace rouleau::core
