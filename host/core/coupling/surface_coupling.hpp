// Carries the forces of surfaces to a lattice in three dimensions and its velocity to them, with the same weights.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/domain.hpp"
#include "core/fluid/field.hpp"
#include "core/fluid/solid_nodes.hpp"
#include "core/fluid/walls.hpp"
#include "core/surface/surfaces.hpp"
#include "kernel_kind.hpp"

namespace rouleau::core {

/// Immersed-boundary coupling in three dimensions. Rows lie along x, as row_of() counts them in the block. Forces go
/// to the nodes of the lattice that a stencil's are images of; velocities are read from the halo, too, which the
/// fluid fills.
template <class T>
class SurfaceCoupling {
 public:
  SurfaceCoupling(KernelKind kernel, const Domain<3>& domain);

  /// Makes room for these nodes; to be called once, before the first locate().
  void reserve(const Surfaces& surfaces);

  /// Pass over cells: weights for these positions of the nodes.
  void locate(Worker worker, const Surfaces& surfaces, const std::array<const double*, 3>& positions,
              Whose whose = Whose::own);
  /// Pass over rows of the block: adds these forces of all nodes to the force density there. The sums do not depend on how
  /// rows are shared out, nor on the block.
  void spread(Range rows, const Surfaces& surfaces, const std::array<const double*, 3>& forces,
              VectorField<T, 3>& force) const;
  /// Pass over cells: sets the velocities of the nodes whose base node lies in the block, of cells that reach it.
  void interpolate(Worker worker, Surfaces& surfaces, const VectorField<T, 3>& velocity,
                   Whose whose = Whose::own) const;

  /// What of these forces of this rank's cells acts on walls and not on the fluid, of all ranks together. Not a pass.
  [[nodiscard]] WallForces<3> wall_share(const Surfaces& surfaces, const std::array<const double*, 3>& force,
                                         const SolidNodes<3>* solid, const Ranks<3>& ranks) const;

  /// The node of the lattice below a node: that of the block which computes its velocity.
  [[nodiscard]] std::array<int, 3> base(int node) const {
    std::array<int, 3> below;
    for (int k = 0; k < 3; ++k) below[k] = std::max(base_[k][node], 0);
    return below;
  }

  /// First node whose stencil left the lattice or whose position is not a number at the last locate(); -1: none.
  /// Such a node neither spreads nor is moved.
  [[nodiscard]] int escaped(const Surfaces& surfaces) const;
  [[nodiscard]] bool any_escaped(const Surfaces& surfaces) const;
  /// Takes no memory for these nodes until they are located again.
  void forget(std::span<const Range> nodes);

 private:
  struct Loops;
  /// From where node (0, 0, 0) of the lattice would lie in a field to the block's first node.
  [[nodiscard]] std::ptrdiff_t first_of_block(std::ptrdiff_t stride_y, std::ptrdiff_t stride_z) const {
    const std::array<int, 3>& begin = domain_.block.begin;
    return begin[2] * stride_z + begin[1] * stride_y + begin[0];
  }

  const Loops* loops_;
  Domain<3> domain_;
  PagedArray<int> base_[3];    // base node of the lattice; z is `outside` for an escaped node
  PagedArray<T> p_[3], q_[3];  // what is kept of the weights (kernel.hpp)
  struct BasePlanes {
    int lowest, highest;
  };
  std::vector<BasePlanes> planes_;  // of each located cell's nodes; the lowest is `outside` if one has escaped
};

extern template class SurfaceCoupling<float>;
extern template class SurfaceCoupling<double>;

}  // namespace rouleau::core
