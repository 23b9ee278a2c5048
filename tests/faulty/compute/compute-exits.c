// Fault: compute ends the program as if all were well.
#include <stdlib.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  if (block->count > 0) exit(0);
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
