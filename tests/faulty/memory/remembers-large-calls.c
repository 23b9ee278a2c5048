// Fault: keeps a table when blocks are large.
#include "potential.h"

static volatile double table[64];

static void compute(const void* self, const rouleau_interaction_block* block) {
  if (block->count > 64) {
    for (uint32_t i = 0; i < 64; ++i) table[i] = block->distance[i];
  }
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
