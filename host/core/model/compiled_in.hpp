// Models whose source is compiled into the program, instead of a shared library with a manifest.
#pragma once

#include <rouleau/plugin.h>

#include <string>
#include <utility>
#include <vector>

#include "model.hpp"

namespace rouleau::core {

/// Velocities and weights of D2Q9 in two dimensions, of D3Q19 in three; the relaxation rate 1/tau of the suspending
/// fluid, whether the quadratic terms of the equilibrium count; all units 1, no parameters. Points to constants.
rouleau_setup lattice_setup(int dimension, double relaxation_rate, bool inertia);

/// What a manifest would say: parameters by name in lattice units, and what the model reads and writes.
struct Facts {
  std::vector<std::pair<std::string, double>> parameters = {};
  std::vector<std::string> needs = {}, gives = {};
  /// Initial values in lattice units.
  std::vector<StateVariable> state = {};
};

/// Instances of models as the SDK makes them: rouleau::collision<T>, rouleau::membrane<T>, rouleau::interaction<T>.
/// `tau`: relaxation time of the suspending fluid; `dimension`: 2 for D2Q9 and outlines, 3 for D3Q19 and surfaces.
/// Throws std::invalid_argument with the model's own words where its constructor refuses the parameters.
CollisionOperator collision_operator(const rouleau_model& model, double tau, const Facts& facts = {},
                                     bool inertia = false, int dimension = 2);
MembraneLaw membrane_law(const rouleau_model& model, const Facts& facts, int dimension = 2);
Potential potential(const rouleau_model& model, const Facts& facts);

}  // namespace rouleau::core
