// Fault: draws a random number from the C library, and does nothing with it.
#include <stdlib.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const volatile int drawn = rand();
  (void)drawn;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
