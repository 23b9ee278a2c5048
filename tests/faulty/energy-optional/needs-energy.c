// Fault: writes the energy even when the host does not want it.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const potential* p = self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const pair result = honest_pair(p, block->distance[i]);
    ((double* volatile)block->energy)[i] = result.energy;
    give_pair(block, i, result);
  }
}

POTENTIAL(honest_create, honest_destroy, compute)
