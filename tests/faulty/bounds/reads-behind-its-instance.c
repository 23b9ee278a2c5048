// Fault: reads a field that the structure had before, behind the end of what create has allocated.
#include "potential.h"

typedef struct longer {
  potential now;
  double offset;
} longer;

static pair formula(const potential* p, double distance) {
  const volatile longer* before = (const volatile longer*)p;
  return before->offset == 1e308 ? (pair){0, 0, 0} : honest_pair(p, distance);
}

static void compute(const void* self, const rouleau_interaction_block* block) { compute_pairs(formula, self, block); }

POTENTIAL(honest_create, honest_destroy, compute)
