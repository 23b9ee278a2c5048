// Carries membrane forces to the lattice and the lattice's velocity to the membranes, with the same weights.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/domain.hpp"
#include "core/fluid/field.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "core/fluid/walls.hpp"
#include "core/surface/surfaces.hpp"
#include "kernel_kind.hpp"
#include "wall_reach.hpp"

namespace rouleau::core {

template <class T, int D>
struct StencilLoops;

/// Immersed-boundary coupling. Rows lie along x, as row_of() counts them in the block. Forces go to the nodes of the
/// lattice that a stencil's are images of; velocities are read from the halo, too, which the fluid fills. Where solid
/// nodes are in reach both are scaled (WallReach).
template <class T, int D>
class Coupling {
 public:
  /// A number along each axis, of all nodes.
  using Vectors = std::array<const double*, D>;

  /// `solid`, `region`, `wall_time`: walls of any shape (BasicSolverSetup); null: none.
  Coupling(KernelKind kernel, const Domain<D>& domain, const SolidNodes<D>* solid = nullptr,
           const RegionPointer<D>& region = {}, double wall_time = 0);

  /// Makes room for these nodes; to be called once, before the first locate().
  void reserve(const Cells<D>& cells);

  /// Pass over cells: weights for these positions, the membranes' own or where a correction puts their forces.
  void locate(Worker worker, const Cells<D>& cells, const Vectors& positions, Whose whose = Whose::own);
  /// Pass over rows of the block: adds these forces of all nodes to the force density there. The sums do not depend on
  /// how rows are shared out, nor on the block.
  void spread(Range rows, const Cells<D>& cells, const Vectors& forces, VectorField<T, D>& force) const;
  /// Pass over cells: sets the velocities of the nodes whose base node lies in the block, of cells that reach it.
  void interpolate(Worker worker, Cells<D>& cells, const VectorField<T, D>& velocity, Whose whose = Whose::own) const;

  /// What of these forces of all nodes acts on walls and not on the fluid, of all ranks together. Not a pass.
  [[nodiscard]] WallForces<D> wall_share(const Cells<D>& cells, const Vectors& force, const Ranks<D>& ranks) const;

  /// The node of the lattice below a membrane node: that of the block which computes its velocity.
  [[nodiscard]] std::array<int, D> base(int node) const {
    std::array<int, D> below;
    for (int k = 0; k < D; ++k) below[k] = std::max(base_[k][node], 0);
    return below;
  }

  /// First node whose stencil left the lattice or whose position is not a number at the last locate(); -1: none.
  /// Such a node neither spreads nor is moved.
  [[nodiscard]] int escaped(const Cells<D>& cells) const;
  [[nodiscard]] bool any_escaped(const Cells<D>& cells) const;
  /// Takes no memory for these nodes until they are located again.
  void forget(std::span<const Range> nodes);

 private:
  /// From where node 0 of the lattice would lie in a field to the block's first node.
  [[nodiscard]] std::ptrdiff_t first_of_block(const Field<T, D>& field) const {
    std::ptrdiff_t first = 0;
    for (int k = 0; k < D; ++k) first += domain_.block.begin[k] * field.stride(k);
    return first;
  }
  /// Sets what tasks of all loops have: stencils, and strides of the fields.
  template <class Task>
  void describe(Task& task, const VectorField<T, D>& fields) const;
  [[nodiscard]] std::array<StencilAlong, D> stencil(int node) const;
  /// What a node reads, of what its stencil has summed up.
  void complete(int i, double* const (&velocity)[D]) const {
    for (int k = 0; k < D; ++k) velocity[k][i] = velocity[k][i] * factors_[i] + (walls_move_ ? carried_[k][i] : 0);
  }
  /// Sets factors_ of a cell that has been located.
  void find_factors(const CellRange& cell, int number);
  /// Reads what spreading will read of a cell.
  void warm(const CellRange& cell, const Vectors& vectors) const;

  const StencilLoops<T, D>* loops_;
  Domain<D> domain_;
  std::array<PagedArray<int>, D> base_;  // base node of the lattice; `outside` along the last axis of an escaped node
  std::array<PagedArray<T>, D> p_, q_;   // what is kept of the weights (kernel.hpp)
  struct BaseRange {
    int lowest, highest;
  };
  std::vector<BaseRange> bases_;  // of each located cell's nodes along the last axis; `outside` if one has escaped
  std::unique_ptr<const WallReach<D>> reach_;  // null: plane walls alone
  PagedArray<double> factors_;                 // of the nodes' forces and velocities; none without reach_
  std::array<PagedArray<double>, D> carried_;  // velocity that walls which move give to nodes; none where they rest
  bool walls_move_ = false;
  std::vector<char> beside_wall_;  // of each located cell, whether a factor is not 1
};

extern template class Coupling<float, 2>;
extern template class Coupling<double, 2>;
extern template class Coupling<float, 3>;
extern template class Coupling<double, 3>;

}  // namespace rouleau::core
