// Keeps the volumes of the cells, as area_correction.hpp keeps areas in two dimensions.
#pragma once

#include "base/worker.hpp"
#include "surface_normals.hpp"

namespace rouleau::core {

// With A_i = dV/dX_i, the gradient of a cell's volume V, and P = 1 - A A^T/(A^T A) for each cell. A has neither a sum
// nor a torque, for no motion of the whole cell changes its volume. `normals`: at the present positions.

/// Pass over cells, once the forces on them are complete: they become P F. Only the pressure in the cell would feel
/// what this takes away; on the lattice it would leak. What is left is the adjoint of keep_enclosed().
void take_out_pressures(Worker worker, Surfaces& surfaces, const SurfaceNormals& normals);

/// Pass over cells, once the velocities are complete: they become P V + c A, where c brings the volume back to its rest
/// value within 50 steps. What V alone would have changed is the leakage; it is added to area_leakage, as
/// keep_enclosed() does.
void keep_enclosed(Worker worker, Surfaces& surfaces, const SurfaceNormals& normals, double strain = 0);

}  // namespace rouleau::core
