// The nodes of all cells of a scene, whatever joins them: one structure of arrays, in lattice units.
#pragma once

#include <cstdint>
#include <vector>

#include "base/worker.hpp"
#include "topology.hpp"

namespace rouleau::core {

/// One cell: its nodes in the arrays of CellNodes.
struct CellRange : Segments {
  int type;                   ///< index into the setup's cell types
  double rest_area = 0;       ///< of an outline, enclosed as created: the fluid inside cannot leave
  double rest_perimeter = 0;  ///< of an outline: sum of the rest lengths
};

/// Positions are not wrapped into the periodic box, so that cells stay whole. The first node of the lattice lies at the
/// origin, walls half a spacing outside the first and the last one. What is along z is empty in two dimensions.
struct CellNodes {
  std::vector<CellRange> cells;
  std::vector<double> x, y, z;                             ///< positions
  std::vector<double> force_x, force_y, force_z;           ///< on the nodes, set anew each step
  std::vector<double> velocity_x, velocity_y, velocity_z;  ///< displacement of the last step
  std::vector<double> largest_step;                        ///< of each cell: no node moved further in the last step;
                                                           ///< empty: unknown
  std::vector<double> area_leakage;                        ///< of each cell, over its rest area: area that the area
                                                           ///< correction has kept from leaving it; empty: none
  std::vector<std::uint8_t> owned;                         ///< of each cell: whether this rank computes its forces and
                                                           ///< moves it; of others it knows where they are; empty: all

  [[nodiscard]] int node_count() const { return static_cast<int>(x.size()); }
  [[nodiscard]] bool owns(int cell) const { return owned.empty() || owned[cell] != 0; }
  [[nodiscard]] int cell_count() const { return static_cast<int>(cells.size()); }
  /// The nodes of a worker's cells, worker.share(cell_count()).
  [[nodiscard]] Range node_share(Worker worker) const {
    const Range share = worker.share(cell_count());
    const auto first = [this](int cell) { return cell < cell_count() ? cells[cell].first : node_count(); };
    return {first(share.begin), first(share.end)};
  }
};

}  // namespace rouleau::core
