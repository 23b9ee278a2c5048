// The lattice on the first rank, a band of rows at a time.
#include "core/domain/bands.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <numeric>
#include <random>
#include <thread>

#include "unit/random.hpp"

namespace rouleau::core {

namespace {

template <int D>
long number_of(const std::array<int, D>& size, const std::array<int, D>& node) {
  long number = 0;
  for (int k = D - 1; k >= 0; --k) number = number * size[k] + node[k];
  return number;
}

/// The numbers of all nodes of a band, in its order.
template <int D>
std::vector<long> nodes_of(const std::array<int, D>& size, const Band<D>& band) {
  std::vector<long> nodes;
  for (const Box<D>& box : band) {
    for (int i = 0; i < row_count(box); ++i) {
      std::array<int, D> node{};
      for (int k = 1; k < D; ++k) node[k] = box.begin[k] + row_of(box, i)[k - 1];
      for (node[0] = box.begin[0]; node[0] < box.end[0]; ++node[0]) nodes.push_back(number_of<D>(size, node));
    }
  }
  return nodes;
}

/// Calls function(ranks, domain) for every rank of a cut, each in a thread of its own; with one block without others.
template <int D, class Function>
void on_ranks(const Decomposition<D>& blocks, Function function) {
  if (blocks.ranks() == 1) return function(Ranks<D>{}, blocks.domain(0));
  const auto ends = make_loopback(blocks.ranks());
  std::vector<std::thread> threads;
  for (int rank = 0; rank < blocks.ranks(); ++rank)
    threads.emplace_back([&, rank] { function(Ranks<D>{&blocks, ends[rank].get()}, blocks.domain(rank)); });
  for (std::thread& thread : threads) thread.join();
}

/// Gives every rank's nodes their numbers and compares what the first one gets.
template <int D>
void check_bands(const Decomposition<D>& blocks, const Bands<D>& bands) {
  const std::array<int, D> size = blocks.domain(0).size;
  int taken = 0;
  long wrong = 0;
  on_ranks(blocks, [&](const Ranks<D>& ranks, const Domain<D>& domain) {
    gather_bands<long>(
        ranks, domain, bands,
        [&](int i, long* to) {
          std::array<int, D> node = domain.block.begin;
          for (int k = 1; k < D; ++k) node[k] += row_of(domain.block, i)[k - 1];
          std::iota(to, to + domain.block.size(0), number_of<D>(size, node));
        },
        [&](int b, const std::vector<long>& values) {
          wrong += b != taken++ || values != nodes_of<D>(size, bands.band(b)) ? 1 : 0;
        });
    // What comes next is not taken for something of the bands.
    if (ranks.several()) wrong += of_first(ranks, std::vector<int>{7}) != std::vector<int>{7} ? 1 : 0;
  });
  CHECK(wrong == 0);
  CHECK(taken == bands.count);
}

/// Cut again and again at random places, until there are so many blocks.
template <int D>
Decomposition<D> random_blocks(const Domain<D>& domain, std::size_t count, std::mt19937& random) {
  std::vector<Box<D>> blocks{domain.block};
  while (blocks.size() < count) {
    Box<D>& block = blocks[std::uniform_int_distribution<std::size_t>(0, blocks.size() - 1)(random)];
    const int axis = std::uniform_int_distribution<int>(0, D - 1)(random);
    if (block.size(axis) < 2) continue;
    Box<D> upper = block;
    upper.begin[axis] = block.end[axis] =
        block.begin[axis] + std::uniform_int_distribution<int>(1, block.size(axis) - 1)(random);
    blocks.push_back(upper);
  }
  return {domain, blocks};
}

template <int D>
void check_cuts(const Domain<D>& domain) {
  auto random = test::generator(static_cast<unsigned>(std::random_device()()));
  const int rows = row_count(domain.block);
  for (const std::size_t count : {1, 2, 3, 5, 8, 13}) {
    const Decomposition<D> blocks = random_blocks(domain, count, random);
    CAPTURE(count);
    for (const int each : {1, 2, 7, rows - 1, rows, 3 * rows}) {
      CAPTURE(each);
      const Bands<D> all = bands_of_all<D>(domain.size, 1, static_cast<std::size_t>(each) * domain.size[0]);
      REQUIRE(all.count == (rows + each - 1) / each);
      std::vector<long> nodes;
      for (int b = 0; b < all.count; ++b) {
        const std::vector<long> of_band = nodes_of<D>(domain.size, all.band(b));
        nodes.insert(nodes.end(), of_band.begin(), of_band.end());
      }
      std::vector<long> expected(static_cast<std::size_t>(domain.nodes()));
      std::iota(expected.begin(), expected.end(), 0);
      REQUIRE(nodes == expected);
      check_bands<D>(blocks, all);
    }
    // Any rows, which overlap from band to band; some bands have none.
    std::vector<Band<D>> some;
    for (int b = 0; b < 9; ++b) {
      std::vector<int> wanted;
      for (int i = 0; i < rows; ++i) {
        if (std::uniform_int_distribution<int>(0, 8)(random) < b) wanted.push_back(i);
      }
      some.push_back(band_of_rows<D>(domain.size, wanted));
    }
    check_bands<D>(blocks, {9, [&](int b) { return some[static_cast<std::size_t>(b)]; }});
  }
}

}  // namespace

TEST_CASE("the first rank gets the rows of a lattice in any bands, from any blocks") {
  check_cuts(Domain<2>({23, 17}, {true, false}));
  check_cuts(Domain<2>({5, 41}, {true, true}));
  check_cuts(Domain<3>({7, 5, 9}, {true, false, true}));
  check_cuts(Domain<3>({11, 3, 4}, {true, true, true}));
}

TEST_CASE("rows that follow each other in a layer are one box of a band") {
  CHECK(band_of_rows<2>({8, 6}, {0, 1, 2, 4}) == Band<2>{{{0, 0}, {8, 3}}, {{0, 4}, {8, 5}}});
  CHECK(band_of_rows<3>({8, 3, 6}, {2, 3, 4, 11}) ==
        Band<3>{{{0, 2, 0}, {8, 3, 1}}, {{0, 0, 1}, {8, 2, 2}}, {{0, 2, 3}, {8, 3, 4}}});
  CHECK(rows_of_band(100, 1000) == 10);
  CHECK(rows_of_band(100, 99) == 1);
}

TEST_CASE("no rank gives more than some bands before the first one has taken them") {
  const Domain<2> domain({30, 200}, {true, false});
  const auto blocks = Decomposition<2>::even(domain, {3, 1});
  std::array<std::atomic<int>, 3> given{};
  int ahead = 0;
  on_ranks(blocks, [&](const Ranks<2>& ranks, const Domain<2>& own) {
    gather_bands<int>(
        ranks, own, bands_of_all<2>(domain.size, 1, 30),
        [&](int i, int* to) {
          std::fill_n(to, own.block.size(0), i);
          ++given[static_cast<std::size_t>(ranks.transport->rank())];
        },
        [&](int b, const std::vector<int>&) {
          if (b < 5) std::this_thread::sleep_for(std::chrono::milliseconds(20));
          for (const std::size_t rank : {1, 2}) ahead = std::max(ahead, given[rank] - (b + 1));
        });
  });
  CHECK(ahead <= bands_ahead + 1);  // one is being made
  CHECK(ahead > 0);
}

}  // namespace rouleau::core
