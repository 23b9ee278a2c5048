// Carries membrane forces to the lattice and the lattice's velocity to the membranes, with the same weights.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/domain.hpp"
#include "core/fluid/field.hpp"
#include "core/fluid/walls.hpp"
#include "core/membrane/membranes.hpp"
#include "kernel_kind.hpp"

namespace rouleau::core {

/// Immersed-boundary coupling. Forces go to the nodes of the lattice that a stencil's are images of; velocities are read
/// from the halo, too, two nodes wide, which the fluid fills.
template <class T>
class Coupling {
 public:
  Coupling(KernelKind kernel, const Domain<2>& domain);

  /// Makes room for these nodes; to be called once, before the first locate().
  void reserve(const Membranes& membranes);

  /// Pass over cells: weights for these positions, the membranes' own or where a correction puts their forces.
  void locate(Worker worker, const Membranes& membranes, NodeVectors position, Whose whose = Whose::own);
  /// Pass over rows of the block: adds the forces of all nodes to the force density there. The sums do not depend on how
  /// rows are shared out, nor on the block.
  void spread(Range rows, const Membranes& membranes, NodeVectors node_force, VectorField<T, 2>& force) const;
  /// Pass over cells: sets velocity_x and velocity_y of the nodes whose base node lies in the block, of cells that reach it.
  void interpolate(Worker worker, Membranes& membranes, const VectorField<T, 2>& velocity,
                   Whose whose = Whose::own) const;

  /// What of these forces of this rank's cells acts on walls and not on the fluid, of all ranks together. Not a pass.
  [[nodiscard]] WallForces<2> wall_share(const Membranes& membranes, NodeVectors force, const Ranks<2>& ranks) const;

  /// The node of the lattice below a membrane node: that of the block which computes its velocity.
  [[nodiscard]] std::array<int, 2> base(int node) const { return {column_[node], std::max(row_[node], 0)}; }

  /// First node whose stencil left the lattice or whose position is not a number at the last locate(); -1: none.
  /// Such a node neither spreads nor is moved.
  [[nodiscard]] int escaped(const Membranes& membranes) const;
  [[nodiscard]] bool any_escaped(const Membranes& membranes) const;
  /// Takes no memory for these nodes until they are located again.
  void forget(std::span<const Range> nodes);

 private:
  struct Loops;
  /// Reads what spreading will read of a cell.
  void warm(const CellRange& cell, NodeVectors vectors) const;

  const Loops* loops_;
  Domain<2> domain_;
  PagedArray<int> column_, row_;         // base node of the lattice; row `outside` for an escaped node
  PagedArray<T> p_x_, q_x_, p_y_, q_y_;  // what is kept of the weights (kernel.hpp)
  struct BaseRows {
    int lowest, highest;
  };
  std::vector<BaseRows> rows_;  // of each located cell's nodes; the lowest is `outside` if one has escaped
};

extern template class Coupling<float>;
extern template class Coupling<double>;

}  // namespace rouleau::core
