// What the bases of membrane laws share: the table.
#ifndef ROULEAU_FAULTY_LAW_H
#define ROULEAU_FAULTY_LAW_H

#include "create.h"

typedef struct segment {
  double tension, energy, tension_by_stretch, tension_by_rate;
} segment;

static inline void give_segment(const rouleau_membrane_block* block, uint32_t i, segment result) {
  if (block->tension != NULL) block->tension[i] = result.tension;
  if (block->energy != NULL) block->energy[i] = result.energy;
  if (block->tension_by_stretch != NULL) block->tension_by_stretch[i] = result.tension_by_stretch;
  if (block->tension_by_rate != NULL) block->tension_by_rate[i] = result.tension_by_rate;
}

#define LAW(create, destroy, compute)                                                                    \
  static const rouleau_membrane functions = {sizeof functions, compute};                                 \
  static const rouleau_model model = {                                                                   \
      sizeof model, ROULEAU_MEMBRANE_KIND, PLUGIN_ID, "1.0.0", create, destroy, NULL, &functions, NULL}; \
  PLUGIN(model)

#endif
