// Fluid fields of a snapshot in SI units.
#pragma once

#include "core/fluid/any_fluid.hpp"
#include "scene/scene.hpp"
#include "snapshot.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::observe {

/// The quantities that the scene asks for, before the next step of a settled fluid whose force has been folded. What
/// they give is computed when it is asked for: fluid and scene must be there until then, the fluid as it is. A band of
/// rows that somebody holds of the lattice takes about `bytes`, or is one row; vorticity needs those beside it, too.
template <int D>
FieldSnapshot observe_fields(const core::AnyFluid<D>& fluid, const scene::Scene& scene,
                             const units::LatticeUnits& units, std::size_t bytes = core::band_bytes);

}  // namespace rouleau::observe
