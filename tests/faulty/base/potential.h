// An honest potential in plain C, phi = stiffness/2 (cutoff - r)^2; faulty plugins replace one piece of it.
#ifndef ROULEAU_FAULTY_POTENTIAL_H
#define ROULEAU_FAULTY_POTENTIAL_H

#include "create.h"

typedef struct potential {
  double stiffness, cutoff;
} potential;

typedef struct pair {
  double energy, force, force_by_distance;
} pair;

static inline pair honest_pair(const potential* p, double distance) {
  const double overlap = p->cutoff - distance;
  const pair result = {p->stiffness / 2 * overlap * overlap, p->stiffness * overlap, -p->stiffness};
  return result;
}

static inline void give_pair(const rouleau_interaction_block* block, uint32_t i, pair result) {
  if (block->energy != NULL) block->energy[i] = result.energy;
  if (block->force != NULL) block->force[i] = result.force;
  if (block->force_by_distance != NULL) block->force_by_distance[i] = result.force_by_distance;
}

/* Every element of a block by a formula. */
static inline void compute_pairs(pair (*formula)(const potential*, double), const void* self,
                                 const rouleau_interaction_block* block) {
  for (uint32_t i = 0; i < block->count; ++i) {
    give_pair(block, i, formula((const potential*)self, block->distance[i]));
  }
}

static inline void honest_compute(const void* self, const rouleau_interaction_block* block) {
  compute_pairs(honest_pair, self, block);
}

static inline double honest_cutoff(const void* self) { return ((const potential*)self)->cutoff; }

static inline int honest_create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  potential made;
  if (read_positive(setup, "stiffness", &made.stiffness, error, error_size) != 0) return 1;
  if (read_positive(setup, "cutoff", &made.cutoff, error, error_size) != 0) return 1;
  return keep(&made, sizeof made, self, error, error_size);
}

/* A model of these functions, called `model`; PLUGIN_ID is the name of the file. */
#define POTENTIAL_MODEL(create, destroy, compute)                                          \
  static const rouleau_interaction functions = {sizeof functions, honest_cutoff, compute}; \
  static const rouleau_model model = {                                                     \
      sizeof model, ROULEAU_INTERACTION_KIND, PLUGIN_ID, "1.0.0", create, destroy, NULL, NULL, &functions};
#define POTENTIAL(create, destroy, compute) \
  POTENTIAL_MODEL(create, destroy, compute) \
  PLUGIN(model)

#endif
