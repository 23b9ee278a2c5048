// Closest points of the nodes of one cell on the outlines of its neighbours.
#pragma once

#include <vector>

#include "base/worker.hpp"
#include "core/membrane/membranes.hpp"
#include "neighbour_list.hpp"
#include "segment_cache.hpp"

namespace rouleau::core {

/// Contacts of the nodes of one cell in structure of arrays; entries [begin, end) of `ranges[p]` belong to its pair p.
/// Node X of the cell, closest point P = (1 - along) X_j + along X_j+1 on segment j of the other cell's image.
struct ContactList {
  std::vector<int> node;     ///< index in Membranes
  std::vector<int> segment;  ///< index in Membranes of the other cell's segment j, its first node
  std::vector<double> along;
  std::vector<double> distance;                  ///< |X - P|, at least `least_distance`
  std::vector<double> direction_x, direction_y;  ///< (X - P) / |X - P|; outward normal of the segment where X = P
  std::vector<Range> ranges;
  int count = 0;  ///< arrays may be longer

  void make_room(std::size_t pairs, std::size_t contacts);

  /// Potentials are promised a positive distance.
  static constexpr double least_distance = 1e-12;
};

/// Exact closest points of all pairs within the cutoffs.
class Contacts {
 public:
  Contacts(const Membranes& membranes, Cutoffs cutoffs, Domain<2> domain);

  /// Pass over cells: their segments, and whether a node has moved too far for the neighbour lists.
  void measure(Worker worker, const Membranes& membranes);
  /// Pass over cells, after a barrier: their neighbour lists, if they have to be made anew.
  void refresh(Worker worker, const Membranes& membranes);
  /// Then: sets `list` to the contacts of a cell. One list serves a worker for cell after cell: kept for all of them
  /// they would leave the cache before they are read.
  void find(int cell, const Membranes& membranes, ContactList& list) const;

  /// Takes no memory for these nodes.
  void forget(const Membranes& membranes, std::span<const Range> nodes) {
    neighbours_.forget(membranes, nodes);
    segments_.forget(nodes);
  }

  [[nodiscard]] NeighbourList& neighbours() { return neighbours_; }
  [[nodiscard]] const NeighbourList& neighbours() const { return neighbours_; }

 private:
  NeighbourList neighbours_;
  SegmentTable segments_;
};

}  // namespace rouleau::core
