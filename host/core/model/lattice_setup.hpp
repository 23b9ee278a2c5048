// What every model is given about the lattice.
#pragma once

#include <rouleau/plugin.h>

namespace rouleau::core {

/// Velocities and weights of D2Q9 in two dimensions, of D3Q19 in three; the relaxation rate 1/tau of the suspending
/// fluid, whether the quadratic terms of the equilibrium count; all units 1, no parameters. Points to constants.
rouleau_setup lattice_setup(int dimension, double relaxation_rate, bool inertia);

}  // namespace rouleau::core
