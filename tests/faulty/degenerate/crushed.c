// Fault: the root of a negative number where a segment is crushed to a thousandth.
#include <math.h>

#include "spring.h"

static segment wrong(const spring* law, double stretch) {
  segment result = honest_segment(law, stretch);
  result.energy += 0 * sqrt(stretch - 1e-3);
  return result;
}

static void compute(const void* self, const rouleau_membrane_block* block) { compute_segments(wrong, self, block); }

LAW(honest_create, honest_destroy, compute)
