// Fault: its tension is not the derivative of its energy.
#include "spring.h"

static segment wrong(const spring* law, double stretch) {
  segment result = honest_segment(law, stretch);
  result.tension *= 1.01;
  result.tension_by_stretch *= 1.01;
  return result;
}

static void compute(const void* self, const rouleau_membrane_block* block) { compute_segments(wrong, self, block); }

LAW(honest_create, honest_destroy, compute)
