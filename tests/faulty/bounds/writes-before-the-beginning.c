// Fault: writes one element before its output.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  honest_compute(self, block);
  if (block->energy != NULL) block->energy[-1] = 0;
}

POTENTIAL(honest_create, honest_destroy, compute)
