// Keeps the areas of the cells: takes what would leak in a step out of the nodes' velocities.
#pragma once

#include "base/worker.hpp"
#include "membranes.hpp"

namespace rouleau::core {

/// Steps in which a difference of area, in three dimensions of volume, goes by a factor e.
inline constexpr double area_relaxation_steps = 50;

/// Pass over cells, once the forces on them are complete: takes the part along dA/dX out of each cell's forces, F_i -=
/// p A_i with p = (F . A)/(A . A). Only the pressure in the cell would feel it; on the lattice it would leak. What is
/// left is the adjoint of keep_enclosed(), and has the same sum and the same torque.
void take_out_pressures(Worker worker, Membranes& membranes);

/// Pass over cells, once the velocities are complete. With A_i = dA/dX_i, every node of a cell gains c A_i, where c
/// makes the sum of V_i . A_i bring the area back to its rest value within 50 steps. What the velocities alone would
/// have changed is the leakage; it is added to area_leakage, positive where the cell would have lost area, which must
/// have one value for each cell, and falls by exp(-strain) in a step: in a steady flow it is the leak of a strain of
/// one.
void keep_enclosed(Worker worker, Membranes& membranes, double strain = 0);

}  // namespace rouleau::core
