// Observables of blood rheology at one instant: flow rate, apparent viscosity, particle stress, sizes of aggregates.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "core/domain/ranks.hpp"
#include "core/fluid/any_fluid.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "scene/scene.hpp"
#include "scene/stage_scales.hpp"
#include "snapshot.hpp"

namespace rouleau::observe {

/// Of a cell: what its interactions say (Interactions::force_across_images). None: nothing acts through images.
using ForceAcrossImages = std::function<std::array<double, 4>(int cell)>;

/// A component of the stress that cells add, and its normal stress differences: xx less yy, and yy less zz, which in
/// two dimensions is NaN. Like the component they are positive where the suspension pulls, along x more than along y.
struct ParticleStress {
  double xy, first, second;
};

/// Stress that the cells add to the suspension, per area of the domain, lattice units: all forces on their
/// membranes, by which cells act on each other, too, and viscosity contrast (Batchelor, J. Fluid Mech. 41, 1970;
/// surface integral of u n + n u over the outline). `viscosity` is that of the suspending fluid; forces and velocities
/// must be those of the present step. All ranks together, of all cells.
ParticleStress particle_stress(const core::Membranes& membranes, const scene::Scene& scene, double viscosity,
                               const core::Ranks<2>& ranks = {}, const ForceAcrossImages& across_images = {});
/// The same of surfaces, per volume of the domain.
ParticleStress particle_stress(const core::Surfaces& surfaces, const scene::Scene& scene, double viscosity,
                               const core::Ranks<3>& ranks = {}, const ForceAcrossImages& across_images = {});

/// Whether a force along x, or openings, drive this stage's fluid between walls at rest: a flow with a flow rate.
bool is_driven_channel(const scene::StageSetting& setting, const scene::Scene& scene);

/// Integral of the velocity along x over the height, averaged over length and depth; lattice units. Between openings
/// that is along their axis; the height is then x if they are along y, the depth x if along z. Exact for velocities
/// that are parabolas in y (midpoint rule with its end correction; the walls' velocity counts as a value). From the
/// mean velocities of the fluid's rows (core::FluidMeasures).
template <int D>
double flow_rate(const core::AnyFluid<D>& fluid, const std::vector<double>& row_velocities);
/// Of a settled fluid, between steps.
template <int D>
double flow_rate(const core::AnyFluid<D>& fluid) {
  return flow_rate(fluid, fluid.row_velocities());
}

/// Flow and pressure at both openings. Returns the mean pressure gradient that drives the flow from one to the other,
/// lattice units.
template <int D>
double observe_openings(const core::AnyFluid<D>& fluid, const scene::Scene& scene, const units::LatticeUnits& units,
                        Snapshot& snapshot);

/// Integral of the velocity along an axis over what the cells enclose, lattice units: from their membranes' velocities,
/// for what they enclose keeps its volume. All ranks together.
double cell_flux(const core::Membranes& membranes, const core::Ranks<2>& ranks = {}, int axis = 0);
double cell_flux(const core::Surfaces& surfaces, const core::Ranks<3>& ranks = {}, int axis = 0);

/// Flow rate of the suspending fluid alone, G H^3 / (12 mu) of plane Poiseuille flow, over `flow_rate` (lattice): the
/// relative apparent viscosity of a driven suspension. Not a number where nothing flows but rounding.
double apparent_viscosity(double flow_rate, double body_force, const scene::StageSetting& setting, int height);

/// Number of aggregates by their number of cells, from a label for each cell.
std::map<int, int> aggregate_sizes(const std::vector<int>& label);
/// Cells per aggregate: sum of n / number of aggregates. NaN without any.
double number_mean(const std::map<int, int>& sizes);
/// Size of the aggregate in which a cell finds itself, averaged over cells: sum of n^2 / sum of n. NaN without any.
double weight_mean(const std::map<int, int>& sizes);

}  // namespace rouleau::observe
