// Fault: the elements behind the last full group of four go another way, which rounds otherwise.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const potential* p = self;
  honest_compute(self, block);
  if (block->energy == NULL) return;
  for (uint32_t i = block->count - block->count % 4; i < block->count; ++i) {
    const double overlap = p->cutoff - block->distance[i];
    block->energy[i] = p->stiffness * (overlap * overlap) / 2;
  }
}

POTENTIAL(honest_create, honest_destroy, compute)
