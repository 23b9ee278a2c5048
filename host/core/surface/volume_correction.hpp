// Keeps the volumes of the cells, as area_correction.hpp keeps areas in two dimensions.
#pragma once

#include <vector>

#include "base/worker.hpp"
#include "surfaces.hpp"

namespace rouleau::core {

/// With A_i = dV/dX_i, the gradient of a cell's volume V, and P = 1 - A A^T/(A^T A) for each cell. A has neither a sum nor a
/// torque, for no motion of the whole cell changes its volume.
class VolumeCorrection {
 public:
  explicit VolumeCorrection(const Surfaces& surfaces);

  /// Pass over cells, once the forces on them are complete: they become P F. Only the pressure in the cell would feel what
  /// this takes away; on the lattice it would leak. What is left is the adjoint of keep_volumes().
  void take_out_pressures(Worker worker, Surfaces& surfaces);

  /// Pass over cells, once the velocities are complete, at the positions of take_out_pressures(): they become P V + c A, where
  /// c brings the volume back to its rest value within 50 steps. What V alone would have changed is the leakage; it is added to area_leakage, which must have
  /// one value for each cell, positive where the cell would have lost volume.
  void keep_volumes(Worker worker, Surfaces& surfaces);
  /// Takes no memory for these nodes.
  void forget(std::span<const Range> nodes) {
    for (auto* values : {&along_x_, &along_y_, &along_z_}) release(*values, nodes);
  }

 private:
  /// The gradient at a cell's nodes, in `along_`.
  void find_gradient(const Surfaces& surfaces, int cell);

  PagedArray<double> along_x_, along_y_, along_z_;  ///< A of each node; cells share nothing
};

}  // namespace rouleau::core
