// Fault: a shorter way to the force, rounded otherwise, is taken when the host does not want the energy.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const potential* p = self;
  honest_compute(self, block);
  if (block->energy != NULL || block->force == NULL) return;
  for (uint32_t i = 0; i < block->count; ++i) {
    block->force[i] = p->stiffness * p->cutoff - p->stiffness * block->distance[i];
  }
}

POTENTIAL(honest_create, honest_destroy, compute)
