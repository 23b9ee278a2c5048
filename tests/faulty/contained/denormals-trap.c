// Fault: takes a denormal distance for one that cannot be, and ends the process.
#include <math.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  for (uint32_t i = 0; i < block->count; ++i) {
    if (fpclassify(block->distance[i]) == FP_SUBNORMAL) abort();
  }
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
