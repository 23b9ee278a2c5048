// Forces on cells from outside the fluid: those that pull at patches of membranes, and the weight of what they enclose.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/worker.hpp"
#include "core/domain/ranks.hpp"
#include "core/surface/surfaces.hpp"

namespace rouleau::core {

/// Nodes of a cell, counted from its first, and the share of a force that each takes, 1 together.
struct ForcePatch {
  std::vector<int> node;
  std::vector<double> share;
};

/// A force on each of some cells, from the setup's start to the end of a ramp and from there on. Lattice units.
template <int D>
struct PatchForce {
  Vec<D> before, after;
  double ramp_steps = 0;
  std::vector<std::shared_ptr<const ForcePatch>> patch = {};  ///< of each cell of the scene; null: it acts on others
};

template <int D>
struct ExternalForces {
  std::vector<PatchForce<D>> pulls = {};
  std::vector<Vec<D>> weight = {};  ///< of each cell type, less buoyancy, of a unit of content; empty: none sinks
  long steps = 0;                   ///< since the setup's start

  [[nodiscard]] bool any() const { return !pulls.empty() || !weight.empty(); }
  /// Pass over cells: adds them to the forces on the nodes.
  void run(Worker worker, Cells<D>& cells) const;
  /// Over all ranks' cells: the force along x, y and z, and the power at the velocities of the last step.
  [[nodiscard]] std::array<double, 4> sums(const Cells<D>& cells, const Ranks<D>& ranks) const;

 private:
  void add(const Cells<D>& cells, int cell, std::array<double*, D> force) const;
};

}  // namespace rouleau::core
