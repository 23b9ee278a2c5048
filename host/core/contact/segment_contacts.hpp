// Closest points of the nodes of one cell on the outlines of its neighbours, and on its own.
#pragma once

#include <optional>
#include <vector>

#include "base/worker.hpp"
#include "contact_law.hpp"
#include "core/membrane/membranes.hpp"
#include "neighbour_list.hpp"
#include "segment_table.hpp"

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

/// Exact closest points of all pairs within the cutoffs.
class SegmentContacts {
 public:
  /// `self_cutoffs`: of each type, within a cell; 0, and where there are none: cells do not touch themselves.
  SegmentContacts(const Membranes& membranes, Cutoffs cutoffs, Domain<2> domain,
                  const std::vector<double>& self_cutoffs = {});

  /// Pass over cells: their segments, and whether a node has moved too far for the neighbour lists.
  void measure(Worker worker, const Membranes& membranes);
  /// Pass over cells, after a barrier: their neighbour lists, if they have to be made anew.
  void refresh(Worker worker, const Membranes& membranes);
  /// Then: sets `list` to the contacts of a cell. One list serves a worker for cell after cell: kept for all of them
  /// they would leave the cache before they are read.
  void find(int cell, const Membranes& membranes, ContactList& list) const;
  /// And the velocities of its nodes against the facing points of other cells, by those of the last step.
  void measure_velocities(int cell, const Membranes& membranes, ContactList& list) const;

  /// Takes no memory for these nodes.
  void forget(const Membranes& membranes, std::span<const Range> nodes) {
    neighbours_.forget(membranes, nodes);
    segments_.forget(nodes);
  }

  /// With other ranks, before measure(): they agree on whether a node has moved too far.
  [[nodiscard]] DisplacementWatch& watch() { return neighbours_.watch(); }
  [[nodiscard]] NeighbourList& neighbours() { return neighbours_; }
  [[nodiscard]] const NeighbourList& neighbours() const { return neighbours_; }

 private:
  NeighbourList neighbours_;
  SegmentTable segments_;
  std::optional<SelfContacts> self_contacts_;
};

}  // namespace rouleau::core
