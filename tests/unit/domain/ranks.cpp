// What ranks find out together: the same on all of them, whoever knew it.
#include "core/domain/ranks.hpp"

#include <catch2/catch.hpp>
#include <thread>

using namespace rouleau::core;

namespace {

/// Of each rank what one(ranks) gives there.
template <class One>
auto of_each(int count, One one) {
  const Decomposition<2> blocks = Decomposition<2>::even(Domain<2>({24, 4}, {true, true}), {count, 1});
  std::vector<decltype(one(Ranks<2>{}))> found(static_cast<std::size_t>(count));
  const auto ends = make_loopback(count);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < count; ++rank)
    threads.emplace_back([&, rank] { found[rank] = one(Ranks<2>{&blocks, ends[rank].get()}); });
  for (std::thread& thread : threads) thread.join();
  return found;
}

}  // namespace

TEST_CASE("the values of any rank come to all others") {
  const int count = GENERATE(1, 2, 3, 5, 8, 12);
  for (int root = 0; root < count; ++root) {
    for (const auto& found : of_each(count, [&](const Ranks<2>& ranks) {
           const int own = ranks.transport->rank();
           return of_rank(ranks, root, std::vector<int>{own, 10 * own});
         }))
      CHECK((found == std::vector<int>{root, 10 * root}));
  }
}

TEST_CASE("all ranks find the best value, whoever has it, and of equal ones the same") {
  const int count = GENERATE(1, 2, 3, 5, 8, 12);
  struct Value {
    double size;
    int rank;
  };
  for (int best = 0; best < count; ++best) {
    const auto found = of_each(count, [&](const Ranks<2>& ranks) {
      const int own = ranks.transport->rank();
      return best_of_all(ranks, Value{own >= best ? 2.0 : 1.0, own}, [](const Value& a, const Value& b) {
        return a.size != b.size ? a.size > b.size : a.rank < b.rank;
      });
    });
    for (const Value& value : found) CHECK((value.size == 2 && value.rank == best));
  }
}

TEST_CASE("values of all ranks come to the first, in the order of ranks, and are joined one by one") {
  const int count = GENERATE(1, 2, 3, 5, 8, 12);
  const auto gathered = of_each(count, [](const Ranks<2>& ranks) {
    const int own = ranks.transport->rank();
    return to_first(ranks, std::vector<int>(static_cast<std::size_t>(own % 3), own));  // some have none
  });
  std::vector<int> expected;
  for (int rank = 0; rank < count; ++rank) expected.insert(expected.end(), static_cast<std::size_t>(rank % 3), rank);
  CHECK(gathered.front() == expected);
  for (int rank = 1; rank < count; ++rank) CHECK(gathered[rank].empty());
  const auto joined = of_each(count, [](const Ranks<2>& ranks) {
    const int own = ranks.transport->rank();
    std::vector<int> values{own, 100 - own};
    join(ranks, values, [](int& least, int other) { least = std::min(least, other); });
    return values;
  });
  CHECK((joined.front() == std::vector<int>{0, 101 - count}));
}
