// Fault: its force is not the derivative of its energy; they agree at half the cutoff alone.
#include "potential.h"

static pair wrong(const potential* p, double distance) {
  const double overlap = p->cutoff - distance;
  pair result = honest_pair(p, distance);
  result.force = 2 * p->stiffness * overlap * overlap / p->cutoff;
  result.force_by_distance = -4 * p->stiffness * overlap / p->cutoff;
  return result;
}

static void compute(const void* self, const rouleau_interaction_block* block) { compute_pairs(wrong, self, block); }

POTENTIAL(honest_create, honest_destroy, compute)
