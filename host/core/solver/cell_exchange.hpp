// What ranks tell each other of their cells.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/contact/interaction_forces.hpp"
#include "core/domain/halo.hpp"
#include "core/membrane/membranes.hpp"

namespace rouleau::core {

/// Every cell has one owner, the rank that computes its forces and moves it; it enters no formula, so that any rank will
/// do. All ranks know where all cells are. Each call is one worker's, between two barriers, and all ranks make the same
/// calls.
class CellExchange {
 public:
  /// `owner[c]`: rank of cell c.
  CellExchange(const Ranks<2>& ranks, std::vector<int> owner) : ranks_(ranks), owner_(std::move(owner)) {}

  /// The rank whose block holds the middle of each cell's bounds.
  static std::vector<int> owners_by_place(const Membranes& membranes, const Decomposition<2>& blocks);

  /// Positions, last displacements and the largest of them in each cell: from owners to all.
  void share_positions(Membranes& membranes) const;
  /// The reactions of potentials, to the owners of the cells that they act on.
  void share_reactions(InteractionForces& forces) const;
  /// Two components for every node: from owners to all.
  void share_forces(const Membranes& membranes, double* force_x, double* force_y) const;
  /// What is looked at and kept between steps beside positions and velocities: forces, what laws and potentials
  /// remember, leaked areas. From owners to all.
  void share_state(Membranes& membranes) const;
  /// Velocities from the ranks that have interpolated them to the owners. `base(node)`: the node of the lattice below a
  /// membrane node, whose rank is the one.
  void collect_velocities(Membranes& membranes, const std::function<std::array<int, 2>(int node)>& base) const;

 private:
  [[nodiscard]] int rank() const { return ranks_.transport->rank(); }
  /// Sends what function(rank, message) packs to every other rank.
  template <class Function>
  void send(Function pack) const;
  /// Gives what has come from every other rank to function(rank, reader).
  template <class Function>
  void receive(Function unpack) const;

  Ranks<2> ranks_;
  std::vector<int> owner_;
};

}  // namespace rouleau::core
