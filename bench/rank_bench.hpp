// A whole step of one rank of many, with its cells, by itself.
#pragma once

#include "plan/plan.hpp"
#include "plan/ranks/blocks.hpp"
#include "plan/ranks/rank_costs.hpp"

namespace rouleau::bench {

/// What a step costs rank `rank` of a scene with cells, in processor time: its own part, ghosts, packing and unpacking,
/// beside what is expected (`cost`). Without a network and waiting: ranks around it take steps in threads, what they
/// send it is written down, and it takes the same steps again alone. Throws Error where the cells' positions are none
/// in the end.
void rank_table(const plan::Plan& plan, const plan::Blocks& blocks, int rank, const plan::RankCost& cost,
                double seconds);
/// Such a rank computes what one process does, and again when it is alone, to the last bit, and hears of the cells that
/// it is expected to hear of. Throws std::runtime_error otherwise.
void check_rank();

}  // namespace rouleau::bench
