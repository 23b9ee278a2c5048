// Fault: compiled with a later header, it reads an appended field of the block without looking at struct_size.
#include "potential.h"

typedef struct later_block {
  rouleau_interaction_block known;
  const double* appended;
} later_block;

static void compute(const void* self, const rouleau_interaction_block* block) {
  const later_block* later = (const later_block*)block;
  const double* volatile appended = later->appended;
  (void)appended;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
