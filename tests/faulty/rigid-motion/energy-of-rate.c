// Fault: stores energy in its dashpot, as much as a spring would under the same tension.
#include "dashpot.h"

static segment wrong(const dashpot* law, double stretch, double rate) {
  segment result = honest_segment(law, stretch, rate);
  result.energy += (law->viscosity * rate) * (law->viscosity * rate) / law->modulus / 2;
  return result;
}

static void compute(const void* self, const rouleau_membrane_block* block) { compute_segments(wrong, self, block); }

LAW(honest_create, honest_destroy, compute)
