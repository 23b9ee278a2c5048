// Fault: compute never ends.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  for (volatile int i = 0;; ++i) honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
