// What frames hold of the nodes of membranes, in SI units.
#pragma once

#include "core/solver/any_solver.hpp"
#include "snapshot.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::observe {

/// Places, tensions and, of surfaces, curvatures of a solver with cells, whose forces have been computed. What the
/// fields give is computed when it is asked for: the solver must be there until then, and be where it is. All ranks
/// together; which cells there are the first one knows.
template <int D>
MembraneSnapshot observe_membranes(core::AnySolver<D>& solver, const units::LatticeUnits& units);

}  // namespace rouleau::observe
