// Moves the cells' nodes by one step.
#pragma once

#include <array>

#include "base/worker.hpp"
#include "cell_nodes.hpp"
#include "core/domain/ranks.hpp"

namespace rouleau::core {

/// Pass over cells: adds the velocity to the positions of this worker's cells (explicit Euler) and sets largest_step,
/// which must have one value for each cell; NaN where a velocity is no number.
void move_nodes(Worker worker, CellNodes& cells);

/// Mean of the displacements of all nodes in the last step, of each by its owner; 0 without nodes. The same on all
/// ranks, which must ask together.
template <int D>
std::array<double, 3> mean_velocity(const CellNodes& cells, const Ranks<D>& ranks);

/// The node of this rank's cells with the largest step, for messages.
struct FarthestNode {
  double step;  ///< lattice spacings; NaN if any velocity is no number
  int node;     ///< whose; -1 without nodes
};
FarthestNode farthest_node(const CellNodes& cells);

/// Largest of all steps; NaN if any is.
double largest_step(const CellNodes& cells);

}  // namespace rouleau::core
