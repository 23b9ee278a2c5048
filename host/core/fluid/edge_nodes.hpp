// The nodes at the border of a block, and those around it: where they lie in an array that has no others.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/domain/domain.hpp"

namespace rouleau::core {

/// The outermost nodes of a block and the nodes around it, one deep. Rows at the ends of the other axes lie there whole, with a
/// node more at both ends; of all others two nodes of each end do.
template <int D>
class EdgeNodes {
 public:
  using Row = std::array<int, D - 1>;
  explicit EdgeNodes(const Box<D>& block) : block_(block) {
    Box<D> around{{}, {}};
    for (int k = 1; k < D; ++k) around.end[k] = block.size(k) + 2;
    around.end[0] = 1;
    for (int i = 0; i < row_count(around); ++i) {
      Row row = row_of(around, i);
      for (int& place : row) --place;
      first_.push_back(count_);
      count_ += whole(row) ? block.size(0) + 2 : 4;
    }
  }

  /// How many there are.
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(count_); }
  /// Whether all nodes of a row are there; its coordinates from the block's first row, in [-1, size].
  [[nodiscard]] bool whole(const Row& row) const {
    for (int k = 1; k < D; ++k) {
      if (row[k - 1] <= 0 || row[k - 1] >= block_.size(k) - 1) return true;
    }
    return false;
  }
  /// Place of a node of a row, x in [-1, nx]; where the row is not whole, of the two first ones and the two last ones.
  [[nodiscard]] std::ptrdiff_t place(int x, const Row& row) const {
    std::ptrdiff_t at = 0;
    for (int k = D - 1; k > 0; --k) at = at * (block_.size(k) + 2) + row[k - 1] + 1;
    const std::ptrdiff_t first = first_[static_cast<std::size_t>(at)];
    return first + (whole(row) || x <= 0 ? x + 1 : x - block_.size(0) + 3);
  }

 private:
  Box<D> block_;
  std::vector<std::ptrdiff_t> first_;  ///< place of each row's first node
  std::ptrdiff_t count_ = 0;
};

}  // namespace rouleau::core
