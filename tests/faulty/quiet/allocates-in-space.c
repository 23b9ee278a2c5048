// Fault: an allocation in every call, of triangles alone.
#include "spring.h"

static void compute(const void* self, const rouleau_membrane_block* block) {
  const double modulus = ((const spring*)self)->modulus;
  if (block->struct_size < sizeof *block || block->invariant_2 == NULL) {
    honest_compute(self, block);
    return;
  }
  double* scratch = (double*)malloc(sizeof(double) * block->count);
  for (uint32_t i = 0; i < block->count && scratch != NULL; ++i) {
    scratch[i] = modulus / 4 * block->invariant_2[i];
    if (block->energy != NULL) block->energy[i] = scratch[i] * block->invariant_2[i] / 2;
    if (block->stress_1 != NULL) block->stress_1[i] = 0;
    if (block->stress_2 != NULL) block->stress_2[i] = scratch[i];
  }
  free(scratch);
}

LAW(honest_create, honest_destroy, compute)
