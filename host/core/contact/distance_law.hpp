// What all contacts ask of a potential: how far it reaches, and what it does at a distance.
#pragma once

#include <vector>

#include "core/model/model.hpp"

namespace rouleau::core {

/// Beyond it the potential does nothing, spacings.
double cutoff_of(const Potential& potential);

/// Whether it neither remembers nor reads velocities.
bool is_of_distance_alone(const Potential& potential);

/// Sets `law` to the force, or the energy, of such a potential at each distance.
void evaluate(const Potential& potential, const std::vector<double>& distance, bool energy, std::vector<double>& law);

}  // namespace rouleau::core
