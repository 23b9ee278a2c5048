// What the blocks of a fluid tell each other of the nodes at their borders.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/domain/domain.hpp"
#include "core/domain/halo.hpp"
#include "fluid_state.hpp"

namespace rouleau::core {

/// So many rows of a block, from its first one on and up to its last one.
struct EndRows {
  int below = 0, above = 0;
};

/// Rows of a block of which other blocks want something (Fluid::end_rows): they keep what they read of its lowest two
/// layers of nodes and of its highest one. `others`: who computes them.
template <int D>
EndRows end_rows(const Domain<D>& domain, const Ranks<D>& others) {
  if (!others.several()) return {};
  constexpr int axis = D - 1;
  const int layers = domain.block.size(axis), rows = row_count(domain.block) / layers;  // of a layer
  const bool apart = !domain.wraps(axis);
  const int below = apart && !domain.wall_below(axis) ? std::min(2, layers) : 0;
  const int above = apart && !domain.wall_above(axis) ? std::min(1, layers - below) : 0;
  return {below * rows, above * rows};
}

/// The outermost nodes of a block and the nodes around it, one deep: where they lie in an array that has no others.
/// Rows at the ends of the other axes lie there whole, with a node more at both ends; of all others two nodes of each
/// end do.
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

/// Messages of a block with others. One worker, and all ranks make the same calls.
template <class T, class Set>
class FluidHalo {
 public:
  static constexpr int dimension = Set::dimension, velocity_count = Set::velocity_count;

  /// The state is that of this rank's block; both live as long as this.
  FluidHalo(FluidState<T, Set>& state, const Ranks<dimension>& ranks);

  /// Before the end of a step: sends what others want of it to those of whose borders the end rows have all.
  void begin_ends();
  /// After it: sends what others still want of it.
  void begin();
  /// Takes what they have sent.
  void end();

  [[nodiscard]] const EdgeNodes<dimension>& edges() const { return edges_; }
  /// Numbers of the nodes around the block, each component an array of edges(), from the ranks that have them.
  void exchange_edges(std::array<double*, dimension> values) const;

 private:
  [[nodiscard]] bool in_end_rows(int layer) const;
  template <class Function>
  void with_arrays(Parity parity, Function function);
  void send(Parity parity, bool early);

  FluidState<T, Set>& state_;
  Ranks<dimension> ranks_;
  EdgeNodes<dimension> edges_;
  std::unique_ptr<Halo<T, dimension>> populations_, velocities_;  ///< the latter null without membranes
  std::unique_ptr<Halo<double, dimension>> edge_values_;
  bool ends_sent_ = false;  ///< of this step
};

extern template class FluidHalo<float, D2Q9>;
extern template class FluidHalo<double, D2Q9>;
extern template class FluidHalo<float, D3Q19>;
extern template class FluidHalo<double, D3Q19>;

}  // namespace rouleau::core
