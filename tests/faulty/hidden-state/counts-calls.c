// Fault: a counter in a global variable changes the result of every later call.
#include "potential.h"

static unsigned calls;

static void compute(const void* self, const rouleau_interaction_block* block) {
  honest_compute(self, block);
  ++calls;
  if (block->energy != NULL) block->energy[0] *= 1 + 1e-15 * calls;
}

POTENTIAL(honest_create, honest_destroy, compute)
