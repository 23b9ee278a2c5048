// What the cells add to the stress of the suspension.
#pragma once

#include <functional>

#include "core/domain/ranks.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "scene/scene.hpp"

namespace rouleau::observe {

/// Of a cell: what its interactions say (Interactions::force_across_images). None: nothing acts through images across
/// y.
using ForceAcrossImages = std::function<double(int cell)>;

/// Stress that the cells add to the suspension, xy component per area of the domain, lattice units: all forces on their
/// membranes, by which cells act on each other, too, and viscosity contrast (Batchelor, J. Fluid Mech. 41, 1970;
/// surface integral of u n + n u over the outline). `viscosity` is that of the suspending fluid; forces and velocities
/// must be those of the present step. All ranks together, of all cells.
double particle_stress(const core::Membranes& membranes, const scene::Scene& scene, double viscosity,
                       const core::Ranks<2>& ranks = {}, const ForceAcrossImages& across_images = {});
/// The same of surfaces, per volume of the domain.
double particle_stress(const core::Surfaces& surfaces, const scene::Scene& scene, double viscosity,
                       const core::Ranks<3>& ranks = {}, const ForceAcrossImages& across_images = {});

}  // namespace rouleau::observe
