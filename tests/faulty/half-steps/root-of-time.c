// Fault: relaxes with the root of the time step, so that many short steps relax more than a long one.
#include "maxwell.h"

static void compute(const void* self, const rouleau_membrane_block* block) {
  const maxwell* law = (const maxwell*)self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double stretch = block->stretch[i], dashpot = block->state[0][i], rate = block->stretch_rate[i];
    const double kept = exp(-sqrt(block->time_step / law->relaxation_time));
    const double before = stretch - block->time_step * rate - dashpot;
    const double strain = kept * before + (1 - kept) * law->relaxation_time * rate;
    const segment result = {law->modulus * strain, law->modulus / 2 * strain * strain, law->modulus * kept, 0};
    give_segment(block, i, result);
    if (block->new_state != NULL) block->new_state[0][i] = dashpot + (stretch - dashpot - strain);
  }
}

LAW(honest_create, honest_destroy, compute)
