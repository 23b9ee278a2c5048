// What interactions are made of in two dimensions and in three: closest points, and how reactions are kept.
#pragma once

#include <vector>

#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "reactions.hpp"
#include "segment_contacts.hpp"
#include "triangle_contacts.hpp"

namespace rouleau::core {

template <int D>
struct ContactsOf;
template <>
struct ContactsOf<2> {
  using Cells = Membranes;
  using Finder = SegmentContacts;
  using List = ContactList;
  using Reactions = TouchedNodes;
};
template <>
struct ContactsOf<3> {
  using Cells = Surfaces;
  using Finder = TriangleContacts;
  struct List : ContactValues {
    std::vector<TriangleContact> contacts;
  };
  using Reactions = std::vector<TouchedCell>;
};

/// What the contacts of a cell's nodes with an image of another cell hold: their half of a pair's energy.
struct PairEnergy {
  int cell, other;
  ImageShift shift;  ///< of the other
  double energy;     ///< lattice units
};

/// Whether a potential between two types is one between these.
inline bool acts_between(const Interaction& interaction, int a, int b) {
  return (interaction.between[0] == a && interaction.between[1] == b) ||
         (interaction.between[0] == b && interaction.between[1] == a);
}

/// Half a node's measure at rest: the other half of a contact's energy is that of the nodes of the other side.
template <class Cells>
auto half_weight(const Cells& cells, int cell) {
  const CellRange& range = cells.cells[cell];
  const double* weight = cells.types[range.type]->node_measure().data();
  return [weight, first = range.first](int node) { return 0.5 * weight[node - first]; };
}

}  // namespace rouleau::core
