// What contacts of one cell do to others, until these take it.
#pragma once

#include <vector>

#include "core/domain/vec.hpp"

namespace rouleau::core {

/// In two dimensions: on the nodes of other cells that a cell's pairs touch (NeighbourList::Pair::reaction).
struct TouchedNodes {
  std::vector<double> x, y;
};

/// In three dimensions: on nodes of another cell, each by its index in Surfaces, in the order in which they were found.
struct TouchedCell {
  struct Reaction {
    int node;
    Vec<3> force;
  };
  int cell;
  std::vector<Reaction> reactions;

  /// Those on a cell among `touched`, where it is added if need be.
  static std::vector<Reaction>& reactions_on(int cell, std::vector<TouchedCell>& touched) {
    for (TouchedCell& known : touched)
      if (known.cell == cell) return known.reactions;
    return touched.emplace_back(TouchedCell{cell, {}}).reactions;
  }
};

}  // namespace rouleau::core
