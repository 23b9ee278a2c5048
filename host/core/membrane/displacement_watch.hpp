// Tells when nodes have moved so far that lists made from their old positions must be made anew.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/worker.hpp"
#include "cell_nodes.hpp"

namespace rouleau::core {

/// Largest distance of nodes [nodes.begin, nodes.end) from where they were; NaN if a position is no number. `old`: x, y
/// and z of all nodes; the last is not read in two dimensions.
double largest_displacement(const CellNodes& cells, std::array<const double*, 3> old, Range nodes);

/// Remembers positions and compares. After construction every cell counts as moved.
///
/// No node has moved further than the sum of its cell's largest steps, so positions are compared only once that sum has
/// passed the limit; the displacement found then takes the sum's place.
class DisplacementWatch {
 public:
  DisplacementWatch() = default;
  explicit DisplacementWatch(const CellNodes& cells);

  /// Pass over cells, once a step, of those that this rank knows; nothing once ranks have agreed on what comes of it. A
  /// barrier must lie between it and the next ones.
  void measure(Worker worker, const CellNodes& nodes);
  /// True if a node of the cell had moved further than its limit (or is not a number) at the last measure().
  [[nodiscard]] bool moved(int cell) const { return moved_[cell] != 0; }
  /// True if any cell has moved, on any rank where these have agreed.
  [[nodiscard]] bool exceeded() const;
  /// One worker, in place of measure(): whether a cell has moved that this rank owns. Then all ranks agree.
  [[nodiscard]] bool measure_own(const CellNodes& nodes);
  void agree(bool exceeded) { agreed_ = exceeded; }
  /// Remembers the present positions of a cell and how far its nodes may move from there. Does not change moved().
  void remember(int cell, const CellNodes& nodes, double limit);

  /// What it knows from one step to the next.
  struct Memory {
    Memory() = default;
    /// Nothing is remembered yet. What these do not know takes no memory.
    explicit Memory(const CellNodes& cells);
    /// Whether something is remembered of the cells that are known.
    [[nodiscard]] bool any(const CellNodes& cells) const;
    /// The known cells are where they were, and it remembers where they are now.
    void exchange_places(CellNodes& cells);

    std::array<PagedArray<double>, 3> position;  ///< of all nodes, as in CellNodes. NaN: nothing remembered
    std::vector<double> limit;                   ///< of each cell
    std::vector<double> bound;                   ///< of each cell: upper bound of its nodes' displacements
  };
  [[nodiscard]] const Memory& memory() const { return memory_; }
  [[nodiscard]] Memory& memory() { return memory_; }
  /// What was remembered of cells that are not known, which have these nodes, is gone, and takes no memory. They have
  /// not moved.
  void forget(const CellNodes& cells, std::span<const Range> nodes);
  /// Goes on from another watch's memory of the same cells. If something is remembered of them, renew() is called with
  /// the known cells where they were: makes again what was made then.
  template <class Renew>
  void recall(Memory memory, CellNodes& cells, Renew renew) {
    if (memory.any(cells)) {
      memory.exchange_places(cells);
      renew();
      memory.exchange_places(cells);
    }
    memory_ = std::move(memory);
  }

 private:
  void measure_cell(int cell, const CellNodes& nodes);

  Memory memory_;
  std::optional<bool> agreed_;
  std::vector<std::uint8_t> moved_;  // 0 or 1 for each cell, so that the answer does not depend on the workers
};

}  // namespace rouleau::core
