// Fluid fields of a snapshot in SI units.
#pragma once

#include "core/fluid/fluid.hpp"
#include "scene/scene.hpp"
#include "snapshot.hpp"
#include "units/lattice_units.hpp"

namespace rouleau::observe {

/// The quantities that the scene asks for, before the next step of a settled fluid whose force has been folded.
template <class T, class Set>
FieldSnapshot observe_fields(core::Fluid<T, Set>& fluid, const scene::Scene& scene, const units::LatticeUnits& units);

}  // namespace rouleau::observe
