// Fault: changes its instance and puts back what was there.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  potential* changed = (potential*)(uintptr_t)self;
  *(volatile double*)&changed->stiffness = changed->stiffness;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
