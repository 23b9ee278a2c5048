// Fields of a snapshot in SI units, of the fluid and of the membranes.
#pragma once

#include "core/fluid/any_fluid.hpp"
#include "core/solver/any_solver.hpp"
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

/// Places, tensions and, of surfaces, curvatures of a solver with cells, whose forces have been computed. What the
/// fields give is computed when it is asked for: the solver must be there until then, and be where it is. All ranks
/// together; which cells there are the first one knows.
template <int D>
MembraneSnapshot observe_membranes(core::AnySolver<D>& solver, const units::LatticeUnits& units);

}  // namespace rouleau::observe
