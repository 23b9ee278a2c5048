// Fault: allocates memory in compute.
#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  double* volatile copy = malloc(block->count * sizeof(double));
  if (copy != NULL) memcpy(copy, block->distance, block->count * sizeof(double));
  honest_compute(self, block);
  free(copy);
}

POTENTIAL(honest_create, honest_destroy, compute)
