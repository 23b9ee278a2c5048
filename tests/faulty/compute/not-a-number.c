// Fault: the root of a negative number for every distance within the cutoff.
#include <math.h>

#include "potential.h"

static pair rooted(const potential* p, double distance) {
  pair result = honest_pair(p, distance);
  result.energy = sqrt(distance - p->cutoff);
  return result;
}

static void compute(const void* self, const rouleau_interaction_block* block) { compute_pairs(rooted, self, block); }

POTENTIAL(honest_create, honest_destroy, compute)
