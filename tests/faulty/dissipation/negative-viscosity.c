// Fault: the sign of its viscosity.
#include "dashpot.h"

static segment wrong(const dashpot* law, double stretch, double rate) {
  dashpot driven = *law;
  driven.viscosity = -law->viscosity;
  return honest_segment(&driven, stretch, rate);
}

static void compute(const void* self, const rouleau_membrane_block* block) { compute_segments(wrong, self, block); }

LAW(honest_create, honest_destroy, compute)
