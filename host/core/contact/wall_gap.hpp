// How near cells come to walls.
#pragma once

#include <cmath>
#include <limits>

#include "core/geometry/region.hpp"
#include "core/membrane/cell_nodes.hpp"

namespace rouleau::core {

/// The node of a cell that is nearest to the border of a region, or farthest beyond it.
template <int D>
struct NearestToBorder {
  double distance = std::numeric_limits<double>::infinity();  ///< spacings, negative beyond the border
  Vec<D> node = Vec<D>::Zero();
};

template <int D>
NearestToBorder<D> nearest_to_border(const CellNodes& nodes, const CellRange& cell, const Region<D>& region) {
  NearestToBorder<D> nearest;
  double last = 0;  // of the node that was measured last
  Vec<D> measured = Vec<D>::Zero();
  for (int i = cell.first; i < cell.end(); ++i) {
    Vec<D> node;
    for (int k = 0; k < D; ++k) node[k] = nodes.position[k][i];
    // From node to node a distance changes by no more than they are apart.
    if (i > cell.first && (node - measured).norm() < last - nearest.distance) continue;
    measured = node;
    last = region.distance(node).value;
    if (last < nearest.distance) nearest = {last, node};
  }
  return nearest;
}

/// Smallest distance of a cell's nodes to a wall, spacings: of the domain, and of a region where there is one. Negative
/// beyond it; NaN without walls, and for nodes that are no numbers.
template <int D>
double wall_gap(const CellNodes& nodes, const CellRange& cell, const Domain<D>& domain,
                const Region<D>* region = nullptr) {
  const BoundingBox<D> box = box_of<D>(nodes, cell);
  if (!box.usable()) return std::nan("");
  double gap =
      region != nullptr ? nearest_to_border(nodes, cell, *region).distance : std::numeric_limits<double>::infinity();
  for (int k = 1; k < D; ++k) {
    if (domain.walled(k)) gap = std::min({gap, box.least[k] + 0.5, domain.size[k] - 0.5 - box.most[k]});
  }
  return std::isinf(gap) ? std::nan("") : gap;
}

}  // namespace rouleau::core
