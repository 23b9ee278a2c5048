// An honest membrane law in plain C, tension = modulus (stretch - 1).
#ifndef ROULEAU_FAULTY_SPRING_H
#define ROULEAU_FAULTY_SPRING_H

#include "law.h"

typedef struct spring {
  double modulus;
} spring;

static inline segment honest_segment(const spring* law, double stretch) {
  const double strain = stretch - 1;
  const segment result = {law->modulus * strain, law->modulus / 2 * strain * strain, law->modulus, 0};
  return result;
}

static inline void compute_segments(segment (*formula)(const spring*, double), const void* self,
                                    const rouleau_membrane_block* block) {
  for (uint32_t i = 0; i < block->count; ++i) {
    give_segment(block, i, formula((const spring*)self, block->stretch[i]));
  }
}

static inline void honest_compute(const void* self, const rouleau_membrane_block* block) {
  compute_segments(honest_segment, self, block);
}

static inline int honest_create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  spring made;
  if (read_positive(setup, "modulus", &made.modulus, error, error_size) != 0) return 1;
  return keep(&made, sizeof made, self, error, error_size);
}

#endif
