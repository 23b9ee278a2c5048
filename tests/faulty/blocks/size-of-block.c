// Fault: large blocks go another way than small ones, which rounds otherwise.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const potential* p = self;
  honest_compute(self, block);
  if (block->energy == NULL || block->count < 16) return;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double overlap = p->cutoff - block->distance[i];
    block->energy[i] = p->stiffness * (overlap * overlap) / 2;
  }
}

POTENTIAL(honest_create, honest_destroy, compute)
