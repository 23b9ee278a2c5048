// Fault: twice as stiff as the parameter says whose role is the stretching modulus.
#include "spring.h"

static segment wrong(const spring* law, double stretch) {
  const spring stiffer = {2 * law->modulus};
  return honest_segment(&stiffer, stretch);
}

static void compute(const void* self, const rouleau_membrane_block* block) { compute_segments(wrong, self, block); }

LAW(honest_create, honest_destroy, compute)
