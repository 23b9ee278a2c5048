// Fault: leaves the thread rounding upward after compute.
#include <fenv.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  honest_compute(self, block);
  fesetround(FE_UPWARD);
}

POTENTIAL(honest_create, honest_destroy, compute)
