// Fault: writes the force's derivative even when the host does not want it.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const potential* p = self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const pair result = honest_pair(p, block->distance[i]);
    ((double* volatile)block->force_by_distance)[i] = result.force_by_distance;
    give_pair(block, i, result);
  }
}

POTENTIAL(honest_create, honest_destroy, compute)
