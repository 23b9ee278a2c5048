// An honest membrane law in plain C, tension = modulus (stretch - 1) + viscosity (stretch rate); faulty plugins replace
// one piece of it.
#ifndef ROULEAU_FAULTY_LAW_H
#define ROULEAU_FAULTY_LAW_H

#include "create.h"

typedef struct law {
  double modulus, viscosity;
} law;

typedef struct segment {
  double tension, energy, tension_by_stretch, tension_by_rate;
} segment;

static inline segment honest_segment(const law* l, double stretch, double stretch_rate) {
  const double strain = stretch - 1;
  const segment result = {l->modulus * strain + l->viscosity * stretch_rate, l->modulus / 2 * strain * strain,
                          l->modulus, l->viscosity};
  return result;
}

static inline void compute_segments(segment (*formula)(const law*, double, double), const void* self,
                                    const rouleau_membrane_block* block) {
  for (uint32_t i = 0; i < block->count; ++i) {
    const segment result = formula((const law*)self, block->stretch[i], block->stretch_rate[i]);
    if (block->tension != NULL) block->tension[i] = result.tension;
    if (block->energy != NULL) block->energy[i] = result.energy;
    if (block->tension_by_stretch != NULL) block->tension_by_stretch[i] = result.tension_by_stretch;
    if (block->tension_by_rate != NULL) block->tension_by_rate[i] = result.tension_by_rate;
  }
}

static inline void honest_compute(const void* self, const rouleau_membrane_block* block) {
  compute_segments(honest_segment, self, block);
}

static inline int honest_create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  law made;
  if (read_positive(setup, "modulus", &made.modulus, error, error_size) != 0) return 1;
  if (read_positive(setup, "viscosity", &made.viscosity, error, error_size) != 0) return 1;
  return keep(&made, sizeof made, self, error, error_size);
}

#define LAW(create, destroy, compute)                                                                    \
  static const rouleau_membrane functions = {sizeof functions, compute};                                 \
  static const rouleau_model model = {                                                                   \
      sizeof model, ROULEAU_MEMBRANE_KIND, PLUGIN_ID, "1.0.0", create, destroy, NULL, &functions, NULL}; \
  PLUGIN(model)
/* A law whose segments follow a formula of their own. */
#define LAW_OF_SEGMENTS(formula)                                               \
  static void compute(const void* self, const rouleau_membrane_block* block) { \
    compute_segments(formula, self, block);                                    \
  }                                                                            \
  LAW(honest_create, honest_destroy, compute)

#endif
