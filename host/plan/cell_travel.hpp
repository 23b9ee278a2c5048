// How fast cells travel with the undisturbed flow, for the unsteady term of creeping flow.
#pragma once

#include "scene/stage_scales.hpp"

namespace rouleau::plan {

/// Without u.grad u the fluid's unsteady term depends on the frame it is seen from: a cell that travels at U in that
/// frame meets its own disturbance as if it were passing by, an error in proportion to density_factor rho U a/mu, a the
/// largest cell's radius. Both are such numbers, U from the undisturbed flow at the cells' centres as they were placed.
struct CellTravel {
  double mean = 0;    ///< of all cells together, in the lattice's frame
  double spread = 0;  ///< of the cell that is farthest from their mean
};
/// None without cells and where convective inertia is kept.
CellTravel cell_travel(const scene::Scene& scene, const scene::StageSetting& stage);

/// The fluid is computed in a frame that moves with the cells where these travel together. Otherwise a capsule drifts across
/// a shear flow in proportion to the mean, by 0.87 of its radius within a strain of 8 at a mean of 2 (docs/rheology.md): the
/// threshold allows 0.001.
/// Not in three dimensions, whose fluid has no such frame.
bool follows_cells(const scene::Scene& scene, const scene::StageSetting& stage);

}  // namespace rouleau::plan
