// Fault: negative stiffness near rest, where the segment would rather be longer or shorter.
#include "spring.h"

static segment wrong(const spring* law, double stretch) {
  const double strain = stretch - 1, well = 0.2, ratio = strain * strain / (well * well);
  const segment result = {law->modulus * strain * (ratio - 1), law->modulus * strain * strain * (ratio / 4 - 0.5),
                          law->modulus * (3 * ratio - 1), 0};
  return result;
}

static void compute(const void* self, const rouleau_membrane_block* block) { compute_segments(wrong, self, block); }

LAW(honest_create, honest_destroy, compute)
