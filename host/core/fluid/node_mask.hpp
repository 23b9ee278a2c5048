// Which nodes of the lattice feel a membrane: one bit for 16 nodes, read as spans.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "core/domain/domain.hpp"

namespace rouleau::core {

/// Consecutive nodes [begin, end) of a row that are all active or all not.
struct MaskSpan {
  int begin, end;
  bool active;
};

/// Active nodes carry force, velocity and relaxation rate; the others are collided without.
class NodeMask {
 public:
  static constexpr int nodes_per_bit = 16;

  NodeMask() = default;
  /// Nothing is active.
  template <int D>
  explicit NodeMask(const Domain<D>& domain)
      : NodeMask({{domain.size[0]}, {domain.periodic[0]}, {{domain.block.begin[0]}, {domain.block.end[0]}}},
                 row_count(domain.block)) {}

  /// Takes the marks of rows [first_row, end_row) away.
  void clear(int first_row, int end_row);
  /// Marks the nodes of row y of the block (Lattice::row) that are images of columns [begin, end) of the lattice; rows
  /// outside the block are left out.
  void mark(int y, int begin, int end);

  /// Calls function(MaskSpan) for the spans of row y, left to right, covering [0, nx) exactly.
  template <class Function>
  void for_spans(int y, Function function) const {
    for (const MaskSpan& span : spans_[y]) function(span);
  }
  [[nodiscard]] bool active(int x, int y) const {
    const int bit = bit_of(x);
    return (bits_[static_cast<std::size_t>(words_) * y + bit / bits_per_word] >> (bit % bits_per_word) & 1) != 0;
  }
  /// Whether any node of row y is active; whether the first or the last one is.
  [[nodiscard]] bool any(int y) const { return spans_[y].size() > 1 || at_side(y); }
  [[nodiscard]] bool at_side(int y) const {
    const std::vector<MaskSpan>& spans = spans_[y];
    return spans.front().active || spans.back().active;
  }
  [[nodiscard]] double active_fraction() const;

 private:
  NodeMask(const Domain<1>& along_x, int rows);
  static constexpr int bits_per_word = 64;
  /// First bit from `bit` on that is not `on`; beyond the row's last bit if there is none.
  [[nodiscard]] int next_change(const std::uint64_t* row, int bit, bool on) const {
    int word = bit / bits_per_word;
    std::uint64_t changed = (on ? ~row[word] : row[word]) >> (bit % bits_per_word) << (bit % bits_per_word);
    while (changed == 0) {
      if (++word == words_) return words_ * bits_per_word;
      changed = on ? ~row[word] : row[word];
    }
    return word * bits_per_word + std::countr_zero(changed);
  }

  /// The bit of node x of the block. Bits stand for the same nodes of the lattice whatever the block, since who computes
  /// with what is active must come to the same numbers in all blocks.
  [[nodiscard]] int bit_of(int x) const { return (x + first_) / nodes_per_bit; }
  /// Nodes [begin, end) of the lattice.
  void mark_nodes(std::uint64_t* row, int begin, int end);
  /// Lists the spans of row y anew from its bits.
  void list_spans(int y);

  Domain<1> along_x_;
  int nx_ = 0, ny_ = 0;
  int first_ = 0;  ///< nodes before the block that its first bit stands for, too
  int words_ = 0;
  std::vector<std::uint64_t> bits_;
  /// Of each row: read several times a step, changed when a membrane has moved.
  std::vector<std::vector<MaskSpan>> spans_;
};

}  // namespace rouleau::core
