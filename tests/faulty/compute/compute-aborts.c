// Fault: compute stops the program, as an assertion that fails does.
#include <stdlib.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  if (block->count > 0) abort();
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
