// Nothing is wrong with this law: what the faulty ones are compared with. In three dimensions w = E/4 (I1 - ln(I2 +
// 1)).
#include <math.h>

#include "spring.h"

static void compute(const void* self, const rouleau_membrane_block* block) {
  const double modulus = ((const spring*)self)->modulus;
  if (block->struct_size < sizeof *block || block->invariant_1 == NULL) {
    honest_compute(self, block);
    return;
  }
  for (uint32_t i = 0; i < block->count; ++i) {
    const double square = block->invariant_2[i] + 1;
    if (block->energy != NULL) block->energy[i] = modulus / 4 * (block->invariant_1[i] - log(square));
    if (block->stress_1 != NULL) block->stress_1[i] = modulus / 4;
    if (block->stress_2 != NULL) block->stress_2[i] = -modulus / 4 / square;
  }
}

LAW(honest_create, honest_destroy, compute)
