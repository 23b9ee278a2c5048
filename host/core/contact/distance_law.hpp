// What all contacts ask of a potential.
#pragma once

#include "core/model/model.hpp"

namespace rouleau::core {

/// Beyond it the potential does nothing, spacings.
double cutoff_of(const Potential& potential);

/// Whether it neither remembers nor reads velocities.
bool is_of_distance_alone(const Potential& potential);

}  // namespace rouleau::core
