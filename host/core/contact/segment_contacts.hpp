// Closest points of the nodes of one cell on the outlines of its neighbours, and on its own.
#pragma once

#include <optional>
#include <vector>

#include "base/worker.hpp"
#include "contact_list.hpp"
#include "core/membrane/membranes.hpp"
#include "neighbour_list.hpp"
#include "segment_table.hpp"
#include "self_contacts.hpp"

namespace rouleau::core {

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
