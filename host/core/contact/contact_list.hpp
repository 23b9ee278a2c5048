// The contacts of one cell's nodes with outlines.
#pragma once

#include <vector>

#include "contact_law.hpp"

namespace rouleau::core {

/// In structure of arrays; entries [begin, end) of `ranges[p]` belong to the cell's pair p (NeighbourList), those of
/// `within` are with the cell itself. Node X of the cell, closest point P = (1 - along) X_j + along X_j+1 on segment j
/// of the other cell's image. The distance is |X - P|, at least `least_distance`.
struct ContactList : ContactValues {
  std::vector<int> node;     ///< index in Membranes
  std::vector<int> segment;  ///< index in Membranes of the other cell's segment j, its first node
  std::vector<double> along;
  /// (X - P) / |X - P|; outward normal of the segment where X = P. Of those within: X - P.
  std::vector<double> direction_x, direction_y;
  std::vector<Range> ranges;
  Range within{0, 0};
  int count = 0;  ///< arrays may be longer

  void make_room(std::size_t pairs, std::size_t contacts) {
    ranges.resize(pairs);
    if (contacts <= node.size()) return;
    for (auto* values : {&node, &segment}) values->resize(contacts);
    for (auto* values : {&along, &distance, &direction_x, &direction_y}) values->resize(contacts);
  }
};

}  // namespace rouleau::core
