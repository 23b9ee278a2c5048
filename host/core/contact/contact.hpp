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
  int count = 0;

  /// Potentials are promised a positive distance.
  static constexpr double least_distance = 1e-12;
};

/// Exact closest points of all pairs within the cutoffs.
class Contacts {
 public:
  Contacts(const Membranes& membranes, Cutoffs cutoffs, Domain<2> domain);

  static constexpr int phases = 2;
  /// Phases 0 and 1, a barrier after each; then contacts of this worker's cells are in list(cell).
  void run(Worker worker, int phase, const Membranes& membranes);

  [[nodiscard]] const ContactList& list(int cell) const { return lists_[cell]; }
  [[nodiscard]] NeighbourList& neighbours() { return neighbours_; }
  [[nodiscard]] const NeighbourList& neighbours() const { return neighbours_; }

 private:
  void reserve(int cell);
  void search(const Membranes& membranes, int cell);

  NeighbourList neighbours_;
  SegmentTable segments_;
  std::vector<ContactList> lists_;
};

}  // namespace rouleau::core
