// What a time step costs, for estimates and for the choice between settings.
#pragma once

#include "scene/scene.hpp"

namespace rouleau::plan {

/// Seconds of one step on one core, as measured with AVX-512 (docs/performance.md); other machines differ by their
/// memory and vector width.
inline double step_cost(double lattice_nodes, double membrane_nodes, scene::Precision precision) {
  return lattice_nodes * (precision == scene::Precision::f64 ? 1.5e-9 : 0.85e-9) + membrane_nodes * 50e-9;
}

}  // namespace rouleau::plan
