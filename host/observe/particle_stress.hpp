// What the cells add to the stress of the suspension.
#pragma once

#include "core/domain/ranks.hpp"
#include "core/membrane/membranes.hpp"
#include "core/surface/surfaces.hpp"
#include "scene/scene.hpp"

namespace rouleau::observe {

/// Stress that the cells add to the suspension, xy component per area of the domain, lattice units: membrane forces and
/// viscosity contrast (Batchelor, J. Fluid Mech. 41, 1970; surface integral of u n + n u over the outline). `viscosity`
/// is that of the suspending fluid; forces and velocities must be those of the present step. All ranks together, of all cells.
double particle_stress(const core::Membranes& membranes, const scene::Scene& scene, double viscosity,
                       const core::Ranks<2>& ranks = {});
/// The same of surfaces, per volume of the domain.
double particle_stress(const core::Surfaces& surfaces, const scene::Scene& scene, double viscosity,
                       const core::Ranks<3>& ranks = {});

}  // namespace rouleau::observe
