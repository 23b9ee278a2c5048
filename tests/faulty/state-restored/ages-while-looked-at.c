// Fault: takes a step in time when the host only looks at the present state.
#include "maxwell.h"

static void compute(const void* self, const rouleau_membrane_block* block) {
  honest_compute(self, block);
  if (block->time_step > 0 || block->new_state == NULL) return;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double stretch = block->stretch[i], dashpot = block->new_state[0][i];
    block->new_state[0][i] = stretch - strain_after(self, stretch, block->stretch_rate[i], dashpot, 1);
  }
}

LAW(honest_create, honest_destroy, compute)
