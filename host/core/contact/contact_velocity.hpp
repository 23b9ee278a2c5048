// How fast facing membranes approach and slide along each other at their contacts.
#pragma once

#include "contact.hpp"
#include "core/membrane/membranes.hpp"

namespace rouleau::core {

/// Velocities of the node against the facing point P of the other outline, for the contacts of one cell (in the order
/// of the list), by the nodes' velocities in the last step.
struct ContactVelocities {
  std::vector<double> normal;      ///< d distance / dt
  std::vector<double> tangential;  ///< positive where the node runs counter-clockwise along its own cell
  std::vector<double> sliding;     ///< its magnitude

  void measure(const ContactList& list, const std::vector<NeighbourList::Pair>& pairs, const Membranes& membranes);
};

}  // namespace rouleau::core
