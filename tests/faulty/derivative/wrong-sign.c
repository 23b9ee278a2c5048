// Fault: gives the derivative of the energy's slope instead of the force's: the other sign.
#include "potential.h"

static pair wrong(const potential* p, double distance) {
  pair result = honest_pair(p, distance);
  result.force_by_distance = -result.force_by_distance;
  return result;
}

static void compute(const void* self, const rouleau_interaction_block* block) { compute_pairs(wrong, self, block); }

POTENTIAL(honest_create, honest_destroy, compute)
