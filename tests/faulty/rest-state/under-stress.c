// Fault: a term that vanishes at the stretch 1.5, not at rest, where it leaves a tension.
#include "spring.h"

static segment wrong(const spring* law, double stretch) {
  const double beyond = stretch - 1.5, modulus = 0.02 * law->modulus;
  segment result = honest_segment(law, stretch);
  result.tension += modulus * beyond * beyond * beyond;
  result.energy += modulus / 4 * beyond * beyond * beyond * beyond;
  result.tension_by_stretch += 3 * modulus * beyond * beyond;
  return result;
}

static void compute(const void* self, const rouleau_membrane_block* block) { compute_segments(wrong, self, block); }

LAW(honest_create, honest_destroy, compute)
