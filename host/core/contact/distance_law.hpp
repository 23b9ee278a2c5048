// What all contacts ask of a potential.
#pragma once

#include <cstddef>
#include <vector>

#include "core/membrane/element_state.hpp"
#include "core/model/model.hpp"

namespace rouleau::core {

/// Beyond it the potential does nothing, spacings.
double cutoff_of(const Potential& potential);

/// Whether it neither remembers nor reads velocities.
bool is_of_distance_alone(const Potential& potential);

/// Whether it reads how facing surfaces slide along each other, with a sign or without.
bool reads_sliding(const Potential& potential);

/// Adds what a potential, the `place`-th of those that share the memory, remembers of so many cells, as far as it is not
/// there from an earlier stage. Returns where its variables stand in memory.variables; empty: it remembers nothing.
std::vector<std::size_t> keep_state(const Potential& potential, std::size_t place, ContactMemory& memory,
                                    std::size_t cells);

}  // namespace rouleau::core
