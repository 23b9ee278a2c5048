// Fault: looks a distance up in a table that ends before the cutoff.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const potential* p = self;
  for (uint32_t i = 0; i < block->count; ++i) {
    if (block->distance[i] > 0.9999 * p->cutoff && block->distance[i] < p->cutoff) abort();
  }
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
