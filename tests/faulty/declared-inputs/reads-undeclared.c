// Fault: uses an input that its manifest does not declare wherever the host happens to give it.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  honest_compute(self, block);
  if (block->normal_velocity == NULL || block->force == NULL) return;
  for (uint32_t i = 0; i < block->count; ++i) block->force[i] -= 0.1 * block->normal_velocity[i];
}

POTENTIAL(honest_create, honest_destroy, compute)
