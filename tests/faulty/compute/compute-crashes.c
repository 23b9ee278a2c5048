// Fault: compute writes to address 0.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  volatile double* volatile nowhere = NULL;
  *nowhere = block->distance[0];
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
