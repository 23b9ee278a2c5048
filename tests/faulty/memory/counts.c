// Fault: counts its calls in a variable that nothing depends on.
#include "potential.h"

static volatile unsigned calls;

static void compute(const void* self, const rouleau_interaction_block* block) {
  calls = calls + 1;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
