// Which failure a run ends with where several ranks have found one.
#include "monitor/node_checks.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "unit/rank_threads.hpp"

using namespace rouleau;
using namespace rouleau::monitor;

TEST_CASE("all ranks take the failure that one process would have found first, to its last bit") {
  Failure failure;
  failure.reason = "non_finite";
  failure.value = std::nan("");
  failure.limit = INFINITY;
  failure.message = "a \"quoted\" sentence";
  failure.remedy = "lower it";
  const int count = GENERATE(1, 2, 3, 7);
  failure.place = GENERATE(scene::Vector(0.1, -3e-300), scene::Vector(0.1, -3e-300, 1.0 / 3));
  const auto blocks = core::Decomposition<2>::even(core::Domain<2>({14, 4}, {true, true}), {count, 1});
  for (int which = 0; which <= count; ++which) {
    std::vector<std::optional<Failure>> found(static_cast<std::size_t>(count));
    test::on_all_ranks(blocks, [&](const core::Ranks<2>& ranks) {
      const int own = ranks.transport->rank();
      std::optional<Failure> mine;
      if (own >= which) {  // the last ones have one, the first of them has the least order
        mine = failure;
        mine->cell = own;
        mine->place[1] = own;
      }
      found[own] = first_failure(ranks, mine, {5, static_cast<double>(own)});
    });
    for (const auto& of_rank : found) {
      REQUIRE(of_rank.has_value() == (which < count));
      if (!of_rank) continue;
      CHECK(of_rank->cell == which);
      CHECK(of_rank->reason == failure.reason);
      CHECK(of_rank->place.dimension() == failure.place.dimension());
      CHECK((of_rank->place.x() == 0.1 && of_rank->place.y() == which && of_rank->place.z() == failure.place.z()));
      CHECK(std::isnan(of_rank->value));
      CHECK(of_rank->limit == failure.limit);
      CHECK(of_rank->message == failure.message);
      CHECK(of_rank->remedy == failure.remedy);
    }
  }
}
