// The undisturbed flow of a stage, as a plan knows it: how it starts, how fast it is, how fast cells travel with it.
#pragma once

#include "scene/stage_scales.hpp"

namespace rouleau::plan {

/// A flow that starts at rest, in strains: its shear rate g(s) over that of the developed flow is 1 - A exp(-s/T) in
/// the end.
struct FlowStart {
  double delay = 0;     ///< by which everything is late for good, the integral of 1 - g; 0: nothing to say
  bool driven = false;  ///< by a force rather than by walls

  [[nodiscard]] double decay() const;  ///< T, of the slowest mode
  /// g in the middle between the walls, or of the flow rate of a channel.
  [[nodiscard]] double rate_at(double strain) const;
  /// What the slowest mode leaves of 1 - g.
  [[nodiscard]] double left_at(double strain) const;
  /// Of the relative viscosity, its mean over the second half of this strain: walls that start pull harder, and a flow
  /// that has not come up yet looks as if it were viscous.
  [[nodiscard]] double left_of_viscosity(double strain) const;
};

/// Of the stage with this index, by what its fluid is denser than the true one, whose own start is part of what is
/// simulated; without cells by all of its density, for then it decides alone when the flow is steady. A stage that is
/// driven as the one before it begins with that one's flow.
FlowStart flow_start(const scene::Scene& scene, int index);

/// Strain within which a round capsule comes to its steady shape, for its capillary number mu g a/Es: from the
/// angles of the boundary integrals in tests/reference/capsule_channel.json, where tan(2 angle) = 1/relaxation.
double capsule_relaxation(double capillary_number, double viscosity_ratio);

/// How far a round capsule that has been started with the flow is from one in the developed flow after this strain,
/// relative to the latter's deformation. Both obey dz/ds = -z/relaxation + i g z + g/relaxation, where |z| is the
/// deformation over a constant and arg z twice the angle: small deformations that relax, are turned by the vorticity
/// and made by the shear.
double capsule_left(const FlowStart& start, double relaxation, double strain);

/// Without u.grad u the fluid's unsteady term depends on the frame it is seen from: a cell that travels at U in that
/// frame meets its own disturbance as if it were passing by, an error in proportion to density_factor rho U a/mu, a the
/// largest cell's radius. Both are such numbers, U from the undisturbed flow at the cells' centres as they were placed.
struct CellTravel {
  double mean = 0;    ///< of all cells together, in the lattice's frame
  double spread = 0;  ///< of the cell that is farthest from their mean
};
/// None without cells and where convective inertia is kept.
CellTravel cell_travel(const scene::Scene& scene, const scene::StageSetting& stage);

/// The fluid is computed in a frame that moves with the cells where these travel together. Otherwise a capsule drifts
/// across a shear flow in proportion to the mean, by 0.87 of its radius within a strain of 8 at a mean of 2
/// (docs/rheology.md): the threshold allows 0.001. Not in three dimensions, whose fluid has no such frame.
bool follows_cells(const scene::Scene& scene, const scene::StageSetting& stage);

/// Largest speed of the developed flow between walls at rest, lattice units.
double fastest_driven_speed(const scene::StageSetting& stage, const scene::Scene& scene);

/// A force across walls is held by a pressure, the force times half of the distance from wall to wall: what that makes
/// of a cell at a wall, relative change of its content.
double compression_by_held_force(const scene::StageSetting& stage, const scene::Scene& scene);

}  // namespace rouleau::plan
