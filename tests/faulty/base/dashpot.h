// An honest membrane law in plain C, a spring beside a dashpot: tension = modulus (stretch - 1) + viscosity (its rate).
#ifndef ROULEAU_FAULTY_DASHPOT_H
#define ROULEAU_FAULTY_DASHPOT_H

#include "law.h"

typedef struct dashpot {
  double modulus, viscosity;
} dashpot;

static inline segment honest_segment(const dashpot* law, double stretch, double rate) {
  const double strain = stretch - 1;
  const segment result = {law->modulus * strain + law->viscosity * rate, law->modulus / 2 * strain * strain,
                          law->modulus, law->viscosity};
  return result;
}

static inline void compute_segments(segment (*formula)(const dashpot*, double, double), const void* self,
                                    const rouleau_membrane_block* block) {
  for (uint32_t i = 0; i < block->count; ++i) {
    give_segment(block, i, formula((const dashpot*)self, block->stretch[i], block->stretch_rate[i]));
  }
}

static inline void honest_compute(const void* self, const rouleau_membrane_block* block) {
  compute_segments(honest_segment, self, block);
}

static inline int honest_create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  dashpot made;
  if (read_positive(setup, "modulus", &made.modulus, error, error_size) != 0) return 1;
  if (read_positive(setup, "viscosity", &made.viscosity, error, error_size) != 0) return 1;
  return keep(&made, sizeof made, self, error, error_size);
}

#endif
