// What drives the flow of a stage.
#pragma once

#include "scene.hpp"

namespace rouleau::scene {

/// Whether the walls move in a stage.
bool walls_move(const Stage& stage);

/// Force per volume that drives the fluid in a stage, N/m3; for a mean velocity what it would take without cells (for
/// walls of any shape: in a channel that is everywhere as wide as they are at the widest place).
Vector driving_force(const Stage& stage, const Scene& scene);

/// Its part that stands for openings, along their axis, N/m3: what would drive a channel or tube that is everywhere as
/// wide as the domain at its widest place as fast as the fluid is where it is fastest, at a mean velocity of the inlet;
/// between two pressures their mean gradient. 0 without openings, and where no wall holds the flow.
double opening_drive(const Scene& scene);

/// Whether the flow that a stage settles to without cells is known, so that `"start": "developed"` can begin with it.
bool knows_developed_flow(const Stage& stage, const Scene& scene);
/// The same of all its stages.
bool knows_developed_flows(const Scene& scene);

/// Whether walls hold the fluid, across y or z.
bool has_walls(const Domain& domain);
/// From wall to wall, m: across y, or across z where y is periodic; the diameter of a tube, or of the largest disc or
/// ball between walls of any shape.
double wall_distance(const Domain& domain);
/// Of a force what no wall across it takes, so that it drives a flow.
Vector unheld(Vector force, const Domain& domain);
/// Its magnitude.
double driving_part(const Vector& force, const Domain& domain);

/// Viscosity of the suspending fluid as a driven channel feels it, Pa s: without layers as it is; with them that of the
/// fluid without layers that the same pressure gradient drives through at the same rate.
double channel_viscosity(const Scene& scene);

/// Flow rate of a channel with walls across z, too, or of a tube, over that of a plane channel in the whole domain, at
/// the same pressure gradient and viscosity; 1 without such walls, NaN between walls of any shape: it is not known.
double duct_share(const Domain& domain);

/// Viscosities of the suspending fluid, Pa s: the least and the largest, layers included.
struct ViscosityRange {
  double least, most;
};
ViscosityRange viscosity_range(const FluidProperties& fluid);

/// Shear rate that a stage's numbers are made with, 1/s: that of the walls where they shear; else that of the
/// developed flow between them, |du/dy| averaged over the height, G H / (4 mu), which is its largest velocity over
/// half the height (in a tube, G R / (4 mu), over the radius), and the speed of walls of a shape over the distance of
/// walls. The largest of an oscillation. 0 at rest, and where no wall holds a flow that is driven.
double mean_shear_rate(const Stage& stage, const Scene& scene);

/// Strain that a flow from a start at rest is late by, for good, for each unit of density_factor; 0 where it starts
/// developed, and where no wall holds it. The error u(y) - u(y, t) of a start-up obeys the diffusion equation; its
/// integral over time gives the lag, which is H^2/(24 nu) for the shear rate in the middle between moving walls, and
/// H^2/(10 nu) for the flow rate of a driven channel and R^2/(6 nu) for that of a tube, nu the kinematic viscosity.
double start_up_strain(const Stage& stage, const Scene& scene);

/// Phase in rad, for each unit of density_factor, by which the fluid's inertia delays an oscillation: of the shear rate
/// in the middle between walls that oscillate against each other, the velocity there between walls that do so together,
/// the flow rate of a channel (1/6, 1/2 and 2/5 of the square of the Womersley number, made with half the height, while
/// that is small; of a tube, made with its radius, 1/6). 0 where nothing oscillates, and where no wall holds the flow.
double oscillation_delay(const Stage& stage, const Scene& scene);

/// Largest Mach number of moving walls without a warning. Without convective inertia the fluid's equations are linear
/// in the velocity, and what is left is the membranes' step in time: a capsule's deformation changes by 2e-4 from 0.03
/// to 0.2 (docs/results/accuracy-2d.md).
inline double largest_wall_mach(bool inertia) { return inertia ? 0.1 : 0.2; }

}  // namespace rouleau::scene
