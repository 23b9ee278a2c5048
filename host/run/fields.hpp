// Fluid fields of a snapshot in SI units.
#pragma once

#include "fluid/fluid.hpp"
#include "input/lattice_units.hpp"
#include "input/scene.hpp"
#include "output/snapshot.hpp"

namespace rouleau::host {

/// The quantities that the scene asks for, before the next step of a settled fluid whose force has been folded.
template <class T>
FieldSnapshot observe_fields(Fluid<T>& fluid, const Scene& scene, const LatticeUnits& units);

}  // namespace rouleau::host
