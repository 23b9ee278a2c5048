// The model of a step by several ranks.
#include "plan/ranks/rank_times.hpp"

#include <bitset>
#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plan/ranks/blocks.hpp"
#include "plan/read_scene.hpp"
#include "unit/blocks_fixture.hpp"

namespace rouleau::plan {
namespace {

const RankTime& by(const RankTimes& times, int ranks) {
  return *std::find_if(times.of.begin(), times.of.end(), [&](const RankTime& time) { return time.ranks == ranks; });
}

}  // namespace

TEST_CASE("a network is a latency, a bandwidth and what further messages take") {
  const Network network = read_network("1.5 us,12 GB/s,300 ns");
  CHECK(network.latency_s == Approx(1.5e-6));
  CHECK(network.bandwidth == Approx(12e9));
  CHECK(network.each_s == Approx(3e-7));
  CHECK(read_network("1 ms, 8e5 kB/s").bandwidth == Approx(8e8));
  for (const char* wrong : {"", "1 us", "1 us,10 GB/s,1 us,1 us", "1 um,10 GB/s", "1 us,10 GB", "1 us,0 GB/s",
                            "-1 us,1 GB/s", "1 us,1 GB/s,", "1,2", "nan us,1 GB/s"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(read_network(wrong), Error);
  }
}

TEST_CASE("messages take a latency for each wait, a moment for each further one, and the bandwidth's time") {
  RankCost cost;
  cost.messages = 12, cost.waits = 5;
  cost.population_bytes = 4000, cost.position_bytes = 6000, cost.received_bytes = 30000;
  const Network network{.latency_s = 2e-6, .bandwidth = 1e9, .each_s = 5e-7};
  CHECK(message_time(cost, network) == Approx(5 * 2e-6 + 7 * 5e-7 + (10000 + 30000) / 2 / 1e9));
  CHECK(message_time(RankCost{}, network) == 0);  // alone
}

TEST_CASE("ranks that share processors take as long as those of the fullest") {
  std::vector<RankCost> ranks(6);
  for (RankCost& rank : ranks) rank.messages = rank.waits = 1;
  for (std::size_t k = 0; k < ranks.size(); ++k) ranks[k].step_s = 1e-3 * static_cast<double>(k + 1);
  ranks[0].sharing_s = 5e-4;
  const Network network{.latency_s = 1e-4, .bandwidth = 1e30, .each_s = 1e-30};
  // 21 ms of computing, 6 times 0.1 ms of messages, and 0.5 ms of sharing.
  CHECK(step_time(ranks, {.network = network}, 1) == Approx(6.1e-3));
  CHECK(step_time(ranks, {.network = network, .processors = 6}, 1) == Approx(6.1e-3));
  CHECK(step_time(ranks, {.network = network, .processors = 1}, 2) == Approx(42e-3 + 0.6e-3 + 0.5e-3));
  // Three of them on each of two processors: the mean of all ways to choose them.
  double expected = 0;
  int ways = 0;
  for (unsigned chosen = 0; chosen < 64; ++chosen) {
    if (std::bitset<6>(chosen).count() != 3) continue;
    double sums[2] = {0, 0};
    for (std::size_t k = 0; k < 6; ++k) sums[chosen >> k & 1] += ranks[k].step_s + ranks[k].sharing_s;
    expected += std::max(sums[0], sums[1]);
    ++ways;
  }
  expected = expected / ways + 3 * 1e-4;
  CHECK(step_time(ranks, {.network = network, .processors = 2}, 1) == Approx(expected).epsilon(0.02));
  // Equal ones do not depend on who is where, but on how many there are.
  for (RankCost& rank : ranks) rank.step_s = 1e-3, rank.sharing_s = 0;
  CHECK(step_time(ranks, {.network = network, .processors = 3}, 1) == Approx(2e-3 + 2e-4));
  CHECK(step_time(ranks, {.network = network, .processors = 4}, 1) == Approx(2e-3 + 2e-4));
}

TEST_CASE("all wait for who has most membranes, and then for who has most of the lattice") {
  std::vector<RankCost> ranks(2);
  ranks[0].step_s = 3e-3, ranks[0].membranes_s = 2e-3;
  ranks[1].step_s = 3e-3, ranks[1].membranes_s = 0;
  CHECK(step_time(ranks, {}, 1) == Approx(2e-3 + 3e-3));
  // Ghosts cost more where own membranes do; packing does not.
  ranks[1].sharing_s = 5e-4, ranks[1].ghosts_s = 2e-4;
  CHECK(step_time(ranks, {}, 2) == Approx(4e-3 + 6e-3 + 4e-4 + 3e-4));
}

TEST_CASE("a fluid alone is as efficient as its blocks are equal, but for what goes over their borders") {
  const scene::Scene scene =
      plan::read_scene(test::four_cells, {test::shear, "/cells=[]", "/interactions=[]"});  // 256 x 128
  const Plan plan = make_plan(scene, test::catalog());
  const Network none{.latency_s = 1e-30, .bandwidth = 1e30, .each_s = 1e-30};
  const RankTimes times =
      rank_times(plan, rank_costs(plan, make_blocks(plan, 8)), {.network = none, .one_step_s = 1e-3});
  CHECK(times.of.size() == 10);  // to 512 blocks of 16 x 4
  for (const RankTime& time : times.of) {
    const std::vector<RankCost> costs = rank_costs(plan, make_blocks(plan, time.ranks));
    double sharing = 0;
    for (const RankCost& cost : costs) sharing = std::max(sharing, cost.sharing_s);
    if (time.ranks == 1) CHECK(sharing == 0);
    CHECK(time.step_s >= 1e-3 / time.ranks);
    CHECK(time.step_s <= 1e-3 / time.ranks + sharing * (1 + 1e-9));
  }
  CHECK(times.fastest == 512);
  // With messages a border has its price.
  const RankTimes slow = rank_times(plan, rank_costs(plan, make_blocks(plan, 3)), {});
  const RankTime& best = by(slow, slow.fastest);
  for (const RankTime& time : slow.of) CHECK(time.step_s >= best.step_s);
  CHECK(by(slow, 3).efficiency < 1);
  CHECK(slow.of.back().efficiency < 0.1);
}

}  // namespace rouleau::plan
