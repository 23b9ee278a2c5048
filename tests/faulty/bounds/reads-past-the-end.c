// Fault: reads one element too many, as loops do that prefetch the next one.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  const volatile double next = block->distance[block->count];
  (void)next;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
