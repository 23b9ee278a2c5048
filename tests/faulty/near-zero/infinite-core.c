// Fault: cells that have come too close for the author have an infinite energy.
#include <math.h>

#include "potential.h"

static pair hard(const potential* p, double distance) {
  pair result = honest_pair(p, distance);
  if (distance < 1e-3 * p->cutoff) result.energy = INFINITY;
  return result;
}

static void compute(const void* self, const rouleau_interaction_block* block) { compute_pairs(hard, self, block); }

POTENTIAL(honest_create, honest_destroy, compute)
