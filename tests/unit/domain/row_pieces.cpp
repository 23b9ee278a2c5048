// Nodes of pieces of rows, and those next to them: where their numbers lie.
#include "core/domain/row_pieces.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "unit/random.hpp"

namespace rouleau::core {

namespace {

template <int D>
void check_places(std::mt19937& random) {
  const auto number = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); };
  Domain<D> domain;
  for (int k = 0; k < D; ++k) {
    domain.size[k] = number(1, k == 0 ? 60 : 5);
    domain.block.end[k] = domain.size[k];
    domain.periodic[k] = number(0, 1) == 1;
  }
  const Box<D>& block = domain.block;
  const int one_in = number(2, 30);
  std::set<std::array<int, D>> wanted, near;
  const auto named = [&](int x, const std::array<int, D - 1>& row) {
    std::array<int, D> node{x};
    std::copy(row.begin(), row.end(), node.begin() + 1);
    return node;
  };
  const RowPieces<D> pieces(domain, [&](int i, auto add) {
    for (int x = 0; x < block.size(0); ++x) {
      if (number(1, one_in) > 1) continue;
      add(x, x + 1);
      wanted.insert(named(x, row_of(block, i)));
    }
  });
  // All that was wanted is in a piece; what is next to a piece has a place, and nothing else.
  for (std::size_t n = 0; n < pieces.first_piece(row_count(block)); ++n) {
    const RowPiece& piece = pieces.piece(n);
    for (int x = piece.begin; x < piece.end; ++x) {
      const std::array<int, D> node = named(x, row_of(block, piece.row));
      wanted.erase(node);
      Box<D> around;
      for (int k = 0; k < D; ++k) around.begin[k] = node[k] - 1, around.end[k] = node[k] + 2;
      for (int i = 0; i < row_count(around); ++i) {
        auto row = row_of(around, i);
        for (int k = 1; k < D; ++k) row[k - 1] += around.begin[k];
        for (int beside = around.begin[0]; beside < around.end[0]; ++beside) {
          near.insert(named(beside, row));
          REQUIRE(pieces.holds(beside, row));
          // Along a piece numbers follow each other, in the rows around it, too.
          REQUIRE(pieces.start(beside, row) == pieces.start(piece.begin, row));
        }
      }
    }
  }
  CHECK(wanted.empty());
  std::set<std::ptrdiff_t> places;
  for (const std::array<int, D>& node : near) {
    std::array<int, D - 1> row;
    std::copy(node.begin() + 1, node.end(), row.begin());
    const std::ptrdiff_t place = pieces.start(node[0], row) + node[0];
    REQUIRE((place >= 0 && place < pieces.count()));
    places.insert(place);
  }
  CHECK(places.size() == near.size());
  CHECK(static_cast<std::ptrdiff_t>(near.size()) == pieces.count());
}

}  // namespace

TEST_CASE("every node of a piece, and every node next to one, has one place; no other has any", "[domain]") {
  std::mt19937 random = test::generator(20261130);
  for (int trial = 0; trial < 40; ++trial) {
    check_places<2>(random);
    check_places<3>(random);
  }
}

TEST_CASE("a row that reaches an opening is one piece", "[domain]") {
  const auto pieces = [](bool periodic) {
    return RowPieces<2>({{50, 1}, {periodic, true}}, [](int, auto add) { add(0, 5), add(30, 40); }).first_piece(1);
  };
  CHECK(pieces(true) == 2);
  CHECK(pieces(false) == 1);
}

}  // namespace rouleau::core
