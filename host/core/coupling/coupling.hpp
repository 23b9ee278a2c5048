// Carries membrane forces to the lattice and the lattice's velocity to the membranes, with the same weights.
#pragma once

#include <cstdint>
#include <vector>

#include "base/worker.hpp"
#include "core/fluid/field.hpp"
#include "core/membrane/membranes.hpp"
#include "kernel_kind.hpp"

namespace rouleau::core {

/// Immersed-boundary coupling. Columns are taken periodically: a node's stencil may reach
/// two columns into the halo, which others fold or fill (fluid/exchange.hpp); so may rows.
template <class T>
class Coupling {
 public:
  Coupling(KernelKind kernel, int nx, int ny, bool periodic_y);

  /// Makes room for these nodes; to be called once, before the first locate().
  void reserve(const Membranes& membranes);

  /// Pass over cells: weights for these positions, the membranes' own or where a correction puts their forces.
  void locate(Worker worker, const Membranes& membranes, NodeVectors position);
  /// Pass over rows: adds the forces of all nodes to this worker's rows worker.share(ny) of the force density; the
  /// first worker owns the lower halo rows too, the last one the upper. The sums do not depend on the workers.
  void spread(Worker worker, NodeVectors node_force, VectorField<T>& force) const;
  /// Pass over cells: sets velocity_x and velocity_y.
  void interpolate(Worker worker, Membranes& membranes, const VectorField<T>& velocity) const;

  /// First node whose stencil left the lattice or whose position is not a number at the last locate(); -1: none.
  /// Such a node neither spreads nor is moved.
  [[nodiscard]] int escaped() const;
  [[nodiscard]] bool any_escaped() const;

 private:
  struct Loops;
  const Loops* loops_;
  int nx_, ny_;
  bool periodic_y_;
  std::vector<int> column_, row_;         // base node, wrapped; row outside_ for an escaped node
  std::vector<T> p_x_, q_x_, p_y_, q_y_;  // what is kept of the weights (kernel.hpp)
  std::vector<std::uint8_t> escaped_;     // of each cell: whether it has an escaped node
};

extern template class Coupling<float>;
extern template class Coupling<double>;

}  // namespace rouleau::core
