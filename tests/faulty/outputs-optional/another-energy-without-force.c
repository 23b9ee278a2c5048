// Fault: the energy is made of the force, or where the host does not want the force another way, rounded otherwise.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const potential* p = self;
  honest_compute(self, block);
  if (block->energy == NULL || block->force == NULL) return;
  for (uint32_t i = 0; i < block->count; ++i) {
    block->energy[i] = block->force[i] * block->force[i] / p->stiffness / 2;
  }
}

POTENTIAL(honest_create, honest_destroy, compute)
