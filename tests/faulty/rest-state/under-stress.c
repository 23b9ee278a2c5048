// Fault: a term that vanishes at the stretch 1.5, not at rest, where it leaves a tension.
#include "spring.h"

static segment wrong(const spring* law, double stretch) {
  const double beyond = stretch - 1.5, modulus = 0.02 * law->modulus;
  segment result = honest_segment(law, stretch);
  result.tension += modulus * beyond;
  result.energy += modulus / 2 * beyond * beyond;
  result.tension_by_stretch += modulus;
  return result;
}

static void compute(const void* self, const rouleau_membrane_block* block) { compute_segments(wrong, self, block); }

LAW(honest_create, honest_destroy, compute)
