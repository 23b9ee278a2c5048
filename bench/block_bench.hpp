// The block of one rank of many, by itself.
#pragma once

#include <string>

namespace rouleau::bench {

/// The fluid of rank `rank` of `ranks` of a scene, its neighbours replaced by itself: what a step costs, and what
/// packing and unpacking its messages cost. Without a network, walls and cells. Throws Error for a scene that cannot be
/// cut so.
void block_table(const std::string& scene, int ranks, int rank, double seconds);
/// Such a block computes what a periodic lattice of its size does, to the last bit. Throws std::runtime_error
/// otherwise.
void check_block();

}  // namespace rouleau::bench
