// Fault: writes to its inputs, if only the value that was there.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  volatile double* distance = (volatile double*)(uintptr_t)block->distance;
  distance[0] = distance[0];
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
