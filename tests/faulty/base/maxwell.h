// An honest membrane law with state in plain C, a spring behind a dashpot (Maxwell): strain' = rate - strain/time.
#ifndef ROULEAU_FAULTY_MAXWELL_H
#define ROULEAU_FAULTY_MAXWELL_H

#include <math.h>

#include "law.h"

typedef struct maxwell {
  double modulus, relaxation_time;
} maxwell;

/* Strain of the spring after a step in which the stretch changed evenly; the rest of the stretch is the dashpot's. */
static inline double strain_after(const maxwell* law, double stretch, double rate, double dashpot, double time_step) {
  const double kept = exp(-time_step / law->relaxation_time);
  const double before = stretch - time_step * rate - dashpot;
  return kept * before + (1 - kept) * law->relaxation_time * rate;
}

static inline void honest_compute(const void* self, const rouleau_membrane_block* block) {
  const maxwell* law = (const maxwell*)self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double stretch = block->stretch[i], dashpot = block->state[0][i];
    const double strain = strain_after(law, stretch, block->stretch_rate[i], dashpot, block->time_step);
    const segment result = {law->modulus * strain, law->modulus / 2 * strain * strain,
                            law->modulus * exp(-block->time_step / law->relaxation_time), 0};
    give_segment(block, i, result);
    if (block->new_state != NULL) block->new_state[0][i] = dashpot + (stretch - dashpot - strain);
  }
}

static inline int honest_create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  maxwell made;
  if (read_positive(setup, "modulus", &made.modulus, error, error_size) != 0) return 1;
  if (read_positive(setup, "relaxation_time", &made.relaxation_time, error, error_size) != 0) return 1;
  return keep(&made, sizeof made, self, error, error_size);
}

#endif
