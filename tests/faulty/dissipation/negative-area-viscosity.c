// Fault: in three dimensions a surface that is blown up gives energy.
#include "dashpot.h"

static void compute(const void* self, const rouleau_membrane_block* block) {
  const double viscosity = ((const dashpot*)self)->viscosity;
  if (block->struct_size < sizeof *block || (block->shear_viscosity == NULL && block->area_viscosity == NULL)) {
    honest_compute(self, block);
    return;
  }
  for (uint32_t i = 0; i < block->count; ++i) {
    if (block->shear_viscosity != NULL) block->shear_viscosity[i] = viscosity;
    if (block->area_viscosity != NULL) block->area_viscosity[i] = -viscosity;
  }
}

LAW(honest_create, honest_destroy, compute)
