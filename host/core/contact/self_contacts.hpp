// Closest points of the nodes of an outline on those parts of it that they may touch.
#pragma once

#include <vector>

#include "core/membrane/membranes.hpp"

namespace rouleau::core {

struct ContactList;

/// Of each node of a cell the closest point of those segments of its own that are at least pi/2 cutoffs away along the
/// outline at rest (half a circle that is a cutoff wide), as SelfReach has it in three dimensions. Which segments these
/// are never changes, so that forces are the exact gradient. A flat membrane, and a round one wider than the cutoff, do
/// nothing to themselves (docs: physics, interaction).
class SelfContacts {
 public:
  /// `cutoffs`: of each type; 0: it does not touch itself.
  SelfContacts(const Membranes& membranes, const std::vector<double>& cutoffs);

  /// Whether cells of a type touch themselves.
  [[nodiscard]] bool acts_on(int type) const { return types_[type].cutoff > 0; }
  /// Appends the contacts of a cell with itself to a list that has room for one of each node.
  void append(const CellRange& cell, const Membranes& membranes, ContactList& list) const;

 private:
  /// Of a node: the segments that it may touch are [begin, end), counted on past the last one to the first again.
  struct Reach {
    int begin, end;
  };
  struct Type {
    double cutoff;
    std::vector<Reach> reach;  ///< of the nodes of a cell
  };
  std::vector<Type> types_;
};

}  // namespace rouleau::core
