// Fault: counts its calls in a thread-local variable.
#include "potential.h"

static _Thread_local volatile unsigned calls;

static void compute(const void* self, const rouleau_interaction_block* block) {
  calls = calls + 1;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
