// Which cells can be near a cell, found without looking at all of them.
#pragma once

#include <array>
#include <vector>

#include "core/domain/bounding_box.hpp"
#include "core/domain/images.hpp"

namespace rouleau::core {

/// Cells sorted into bins by the middle of their bounds. A bin is as large as the largest cell and the reach together,
/// so that whatever is within reach of a cell lies in its own bin or in one of those around it, over periodic
/// borders too. Building and asking cost a time proportional to the number of cells.
template <int D>
class CellGrid {
 public:
  /// Boxes that are not usable() are near nothing.
  CellGrid(const std::vector<BoundingBox<D>>& boxes, double reach, const Domain<D>& domain);

  /// Sets `near` to the cells in the bins around that of `cell`, itself included, each once, in no particular order.
  void find(int cell, std::vector<int>& near) const;

 private:
  struct Axis {
    double origin = 0, width = 1;
    int count = 1;
    bool periodic = false;
    [[nodiscard]] int bin(double middle) const;
  };
  static Axis make_axis(double least, double most, double width, double period);
  /// Calls function(bin) for the bins around `bin` along an axis, each once.
  template <class Function>
  static void for_around(const Axis& axis, int bin, Function function);
  /// Appends the cells of the bins around `bin` along the axes up to `axis`, of those that begin with `first`.
  void append(int axis, int bin, int first, std::vector<int>& near) const;

  std::array<Axis, D> axes_;
  std::vector<int> bin_;    // of each cell; -1: not usable
  std::vector<int> begin_;  // of each bin: its first place in cells_, and one more
  std::vector<int> cells_;  // bin by bin
};

extern template class CellGrid<2>;
extern template class CellGrid<3>;

}  // namespace rouleau::core
