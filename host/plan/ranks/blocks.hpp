// How the lattice of a scene is cut for several ranks.
#pragma once

#include <variant>
#include <vector>

#include "core/domain/decomposition.hpp"
#include "core/domain/ranks.hpp"
#include "core/membrane/cell_nodes.hpp"
#include "plan/plan.hpp"

namespace rouleau::plan {

/// In two dimensions or in three, as the scene.
using Blocks = std::variant<core::Decomposition<2>, core::Decomposition<3>>;

/// How many ranks a lattice has room for.
int most_blocks(const Plan& plan);

/// Throws Error(bad_input) where a rank would compute more nodes than it can. `blocks`: null, of one process.
void require_computable(const scene::Scene& scene, const Blocks* blocks);

/// Blocks of about the same cost, one for each rank, for the cells' first places. Throws Error(bad_input) for more
/// ranks than the lattice has room for.
Blocks make_blocks(const Plan& plan, int ranks);

/// The same for where the cells are now, of which each rank knows its own; all ranks together. `seconds[r]`: what rank
/// r of the present blocks has been measured to take for its own, in the same time as the others.
template <int D>
core::Decomposition<D> cut_again(const Plan& plan, const core::Ranks<D>& ranks, const core::CellNodes& cells,
                                 const std::vector<double>& seconds);

}  // namespace rouleau::plan
