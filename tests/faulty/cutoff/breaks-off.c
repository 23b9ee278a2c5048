// Fault: claims to end smoothly at its cutoff, where its energy and force are not zero.
#include "potential.h"

static pair broken_off(const potential* p, double distance) {
  const double beyond_half = distance - p->cutoff / 2, factor = p->stiffness / p->cutoff;
  pair result = honest_pair(p, distance);
  result.energy -= factor * beyond_half * beyond_half * beyond_half;
  result.force += 3 * factor * beyond_half * beyond_half;
  result.force_by_distance += 6 * factor * beyond_half;
  return result;
}

static void compute(const void* self, const rouleau_interaction_block* block) {
  compute_pairs(broken_off, self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
