// Fault: what is no number counts as beyond the cutoff, so that a run that has gone wrong goes on.
#include "potential.h"

static pair formula(const potential* p, double distance) {
  const pair none = {0, 0, 0};
  return distance <= p->cutoff ? honest_pair(p, distance) : none;
}

static void compute(const void* self, const rouleau_interaction_block* block) { compute_pairs(formula, self, block); }

POTENTIAL(honest_create, honest_destroy, compute)
