// Fault: one distance that is not a number makes every result of the block not a number.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  double sum = 0;
  for (uint32_t i = 0; i < block->count; ++i) sum += 0 * block->distance[i];
  honest_compute(self, block);
  if (block->force == NULL) return;
  for (uint32_t i = 0; i < block->count; ++i) block->force[i] += sum;
}

POTENTIAL(honest_create, honest_destroy, compute)
