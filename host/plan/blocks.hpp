// How the lattice of a scene is cut for several ranks.
#pragma once

#include "core/domain/decomposition.hpp"
#include "plan.hpp"

namespace rouleau::plan {

/// How many ranks a lattice has room for.
int most_blocks(const Plan& plan);

/// Blocks of about the same cost, one for each rank, for the cells' first places. Throws Error(bad_input) for more ranks
/// than the lattice has room for.
core::Decomposition<2> make_blocks(const Plan& plan, int ranks);

}  // namespace rouleau::plan
