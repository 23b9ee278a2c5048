// Carries the forces of surfaces to a lattice in three dimensions and its velocity to them, with the same weights.
#pragma once

#include <vector>

#include "base/worker.hpp"
#include "core/domain/domain.hpp"
#include "core/fluid/field.hpp"
#include "core/surface/surfaces.hpp"
#include "kernel_kind.hpp"

namespace rouleau::core {

/// Immersed-boundary coupling in three dimensions. Rows lie along x: row y + height z holds the nodes (., y, z). Forces go
/// to the nodes of the lattice that a stencil's are images of; velocities are read from the halo, too, two nodes wide,
/// which the fluid fills.
template <class T>
class SurfaceCoupling {
 public:
  SurfaceCoupling(KernelKind kernel, const Domain<3>& domain);

  /// Makes room for these nodes; to be called once, before the first locate().
  void reserve(const Surfaces& surfaces);

  /// Pass over cells: weights for the present positions.
  void locate(Worker worker, const Surfaces& surfaces);
  /// Pass over rows: adds the forces of all nodes to the force density there. The sums do not depend on how rows are
  /// shared out.
  void spread(Range rows, const Surfaces& surfaces, VectorField<T, 3>& force) const;
  /// Pass over cells: sets the nodes' velocities.
  void interpolate(Worker worker, Surfaces& surfaces, const VectorField<T, 3>& velocity) const;

  /// First node whose stencil left the lattice or whose position is not a number at the last locate(); -1: none.
  /// Such a node neither spreads nor is moved.
  [[nodiscard]] int escaped() const;
  [[nodiscard]] bool any_escaped() const;

 private:
  struct Loops;

  const Loops* loops_;
  Domain<3> domain_;
  std::vector<int> base_[3];    // base node of the lattice; z is `outside` for an escaped node
  std::vector<T> p_[3], q_[3];  // what is kept of the weights (kernel.hpp)
  struct BasePlanes {
    int lowest, highest;
  };
  std::vector<BasePlanes> planes_;  // of each cell's nodes; the lowest is `outside` if one has escaped
};

extern template class SurfaceCoupling<float>;
extern template class SurfaceCoupling<double>;

}  // namespace rouleau::core
