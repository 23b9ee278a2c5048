// Where numbers of a block's nodes lie that has them for some nodes only, and for those next to them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "domain.hpp"

namespace rouleau::core {

/// Nodes [begin, end) of row `row` of a block.
struct RowPiece {
  int row, begin, end;
};

/// Pieces of rows, and an array of one number for each of their nodes and for every node next to one, in the halo of
/// one node, too. Rows that lie around the block are counted from -1; x from the block's first node.
template <int D>
class RowPieces {
 public:
  using Row = std::array<int, D - 1>;

  /// All nodes are there; memory is not this class's matter.
  RowPieces() = default;
  /// `runs(i, add)` calls add(begin, end) for the nodes of row i that are wanted; what little lies between them belongs
  /// to a piece, too. A row that reaches an opening is one piece.
  template <class Runs>
  RowPieces(const Domain<D>& domain, Runs runs) : block_(domain.block) {
    constexpr int little = 8;
    first_piece_.push_back(0);
    for (int i = 0; i < row_count(block_); ++i) {
      std::vector<RowPiece> found;
      runs(i, [&](int begin, int end) { found.push_back({i, begin, end}); });
      bool opens = false;
      if (const int k = domain.open_axis; k > 0) {
        const int place = block_.begin[k] + row_of(block_, i)[k - 1];
        opens = place == 0 || place == domain.size[k] - 1;
      } else if (k == 0 && !found.empty()) {
        const int x = block_.begin[0];
        opens = x + found.front().begin == 0 || x + found.back().end == domain.size[0];
      }
      const int between = opens ? block_.size(0) : little;
      for (const RowPiece& piece : found) {
        const bool first = pieces_.size() == first_piece_.back();
        if (!first && piece.begin - pieces_.back().end <= between) {
          pieces_.back().end = piece.end;
        } else {
          pieces_.push_back(piece);
        }
      }
      first_piece_.push_back(pieces_.size());
    }
    Box<D> around = block_;
    for (int k = 1; k < D; ++k) around.end[k] = around.begin[k] + block_.size(k) + 2;
    first_run_.push_back(0);
    for (int i = 0; i < row_count(around); ++i) {
      Row row = row_of(around, i);
      for (int& place : row) --place;
      add_runs(row);
      first_run_.push_back(runs_.size());
    }
  }

  /// Whether all nodes are there.
  [[nodiscard]] bool all() const { return first_piece_.empty(); }
  [[nodiscard]] std::ptrdiff_t count() const { return count_; }
  [[nodiscard]] std::size_t first_piece(int row) const { return first_piece_[static_cast<std::size_t>(row)]; }
  [[nodiscard]] const RowPiece& piece(std::size_t number) const { return pieces_[number]; }
  [[nodiscard]] std::size_t bytes() const { return pieces_.size() * sizeof(RowPiece) + runs_.size() * sizeof(Run); }

  /// What to add to x for a node's place in the array, where the node at x has one; as long as that goes on.
  [[nodiscard]] std::ptrdiff_t start(int x, const Row& row) const {
    const Run* const run = find(x, row);
    return run == nullptr ? 0 : run->start;
  }
  [[nodiscard]] bool holds(int x, const Row& row) const { return find(x, row) != nullptr; }

 private:
  struct Run {
    int begin, end;
    std::ptrdiff_t start;
  };

  /// The runs of nodes of a row, in or around the block, that are in a piece or next to one.
  void add_runs(const Row& row);
  [[nodiscard]] std::size_t number_of(const Row& row) const;
  [[nodiscard]] const Run* find(int x, const Row& row) const;

  Box<D> block_{};
  std::ptrdiff_t count_ = 0;
  std::vector<RowPiece> pieces_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_piece_, first_run_;  ///< of each row, and the end
};

extern template class RowPieces<2>;
extern template class RowPieces<3>;

}  // namespace rouleau::core
