// All segments of all membranes as the search for closest points wants them, made anew each step.
#pragma once

#include <rouleau/pack.hpp>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/images.hpp"
#include "core/membrane/membranes.hpp"

namespace rouleau::core {

/// Index i is node i, and segment i that begins there. Arrays are readable `margin` elements beyond the last node.
class SegmentTable {
 public:
  static constexpr int margin = 8;

  explicit SegmentTable(const Membranes& membranes);
  /// Pass over cells.
  void update(Worker worker, const Membranes& membranes);

  /// Takes no memory for these nodes.
  void forget(std::span<const Range> nodes) {
    for (auto* values : {&x, &y, &along_x, &along_y, &inverse_square}) release(*values, nodes);
  }

  PagedArray<double> x, y;              ///< positions of the nodes
  PagedArray<double> along_x, along_y;  ///< from the node to the next one
  PagedArray<double> inverse_square;    ///< 1 / length^2 of the segment; 0 if it has no length
  std::vector<BoundingBox<2>> boxes;    ///< of the cells
};

/// From the closest point of a segment to a node; `along` is the segment's coordinate of that point in [0, 1].
template <class S>
struct Approach {
  S x, y, along, square;
  /// (dx, dy): from the segment's first node to the node.
  ROULEAU_ALWAYS_INLINE Approach(const S& dx, const S& dy, const S& along_x, const S& along_y,
                                 const S& inverse_square) {
    along = max(min((dx * along_x + dy * along_y) * inverse_square, S(1.0)), S(0.0));
    x = dx - along * along_x;
    y = dy - along * along_y;
    square = x * x + y * y;
  }
};

}  // namespace rouleau::core
