// Fault: a step gives the mean of the force over the step in place of that at its end.
#include "maxwell.h"

static void compute(const void* self, const rouleau_membrane_block* block) {
  const maxwell* law = (const maxwell*)self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double stretch = block->stretch[i], dashpot = block->state[0][i], rate = block->stretch_rate[i];
    const double strain = strain_after(law, stretch, rate, dashpot, block->time_step);
    const double mean = (strain + stretch - block->time_step * rate - dashpot) / 2;
    const segment result = {law->modulus * mean, law->modulus / 2 * strain * strain,
                            law->modulus * exp(-block->time_step / law->relaxation_time), 0};
    give_segment(block, i, result);
    if (block->new_state != NULL) block->new_state[0][i] = dashpot + (stretch - dashpot - strain);
  }
}

LAW(honest_create, honest_destroy, compute)
