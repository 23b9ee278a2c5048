// Fault: its manifest gives the energy, which it never writes.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  rouleau_interaction_block without = *block;
  without.energy = NULL;
  honest_compute(self, &without);
}

POTENTIAL(honest_create, honest_destroy, compute)
