// Which nodes of the lattice feel a membrane: one bit for 16 nodes, read as spans.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/domain/domain.hpp"
#include "solid_nodes.hpp"

namespace rouleau::core {

/// Consecutive nodes [begin, end) of a row that are all active or all not.
struct MaskSpan {
  int begin, end;
  bool active;
};

/// Active nodes carry force, velocity and relaxation rate; the others are collided without. Solid nodes are no part of
/// any span.
class NodeMask {
 public:
  static constexpr int nodes_per_bit = 16;

  NodeMask() = default;
  /// Nothing is active. `solid`: null, or the solid nodes.
  template <int D>
  explicit NodeMask(const Domain<D>& domain, const SolidNodes<D>* solid = nullptr)
      : NodeMask({{domain.size[0]}, {domain.periodic[0]}, {{domain.block.begin[0]}, {domain.block.end[0]}}},
                 row_count(domain.block)) {
    if (solid != nullptr) keep_out(domain, *solid);
  }

  /// Marks the nodes of row y of the block (Lattice::row) that are images of columns [begin, end) of the lattice; rows
  /// outside the block are left out.
  void mark(int y, int begin, int end) {
    if (add_marks(y, begin, end)) list_spans(y);
  }
  /// The same for rows [first_row, end_row), whose marks are those that `add` gives to function(y, begin, end).
  template <class Add>
  void renew(int first_row, int end_row, Add add) {
    const auto first = bits_.begin() + static_cast<std::ptrdiff_t>(words_) * first_row;
    std::fill(first, first + static_cast<std::ptrdiff_t>(words_) * (end_row - first_row), 0);
    add([this](int y, int begin, int end) { add_marks(y, begin, end); });
    for (int y = first_row; y < end_row; ++y) list_spans(y);
  }

  /// Calls function(MaskSpan) for the spans of row y, left to right, covering [0, nx) exactly, but for solid nodes. A
  /// row of nothing else has an empty span.
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
  /// Calls function(begin, end) for the runs of fluid, or of solid nodes, of row y.
  template <class Function>
  void for_fluid(int y, Function function) const {
    if (fluid_.empty()) return function(0, nx_);
    for (const auto& [begin, end] : fluid_[y]) function(begin, end);
  }
  template <class Function>
  void for_solid(int y, Function function) const {
    if (fluid_.empty()) return;
    int last = 0;
    for (const auto& [begin, end] : fluid_[y]) {
      if (last < begin) function(last, begin);
      last = end;
    }
    if (last < nx_) function(last, nx_);
  }
  /// Whether any node of row y is marked, solid or not.
  [[nodiscard]] bool marked(int y) const {
    const auto row = bits_.begin() + static_cast<std::ptrdiff_t>(words_) * y;
    return std::any_of(row, row + words_, [](std::uint64_t word) { return word != 0; });
  }

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

  /// The bit of node x of the block. Bits stand for the same nodes of the lattice whatever the block, since who
  /// computes with what is active must come to the same numbers in all blocks.
  [[nodiscard]] int bit_of(int x) const { return (x + first_) / nodes_per_bit; }
  /// Whether there were any to mark; spans are as before.
  bool add_marks(int y, int begin, int end);
  /// Nodes [begin, end) of the lattice.
  void mark_nodes(std::uint64_t* row, int begin, int end);
  template <int D>
  void keep_out(const Domain<D>& domain, const SolidNodes<D>& solid) {
    fluid_.resize(static_cast<std::size_t>(ny_));
    for (int y = 0; y < ny_; ++y) {
      const auto row = row_of(domain.block, y);
      std::array<int, D> node;
      for (int k = 1; k < D; ++k) node[k] = domain.block.begin[k] + row[k - 1];
      for (int x = 0, begin = 0; x <= nx_; ++x) {
        node[0] = domain.block.begin[0] + x;
        if (x < nx_ && !solid.at(node)) continue;
        if (begin < x) fluid_[y].push_back({begin, x});
        begin = x + 1;
      }
      list_spans(y);
    }
  }
  /// Lists the spans of row y anew from its bits.
  void list_spans(int y);
  void leave_solid_out(int y);

  Domain<1> along_x_;
  int nx_ = 0, ny_ = 0;
  int first_ = 0;  ///< nodes before the block that its first bit stands for, too
  int words_ = 0;
  std::vector<std::uint64_t> bits_;
  /// Of each row: read several times a step, changed when a membrane has moved.
  std::vector<std::vector<MaskSpan>> spans_;
  struct Run {
    int begin, end;
  };
  std::vector<std::vector<Run>> fluid_;  ///< of each row; empty without solid nodes
};

}  // namespace rouleau::core
