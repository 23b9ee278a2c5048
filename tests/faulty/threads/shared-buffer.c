// Fault: keeps what it works on in a static buffer, which concurrent calls share.
#include "potential.h"

enum { length = 64 };
static double buffer[length];

static void compute(const void* self, const rouleau_interaction_block* block) {
  for (uint32_t first = 0; first < block->count; first += length) {
    const uint32_t valid = block->count - first < length ? block->count - first : length;
    memcpy(buffer, block->distance + first, valid * sizeof(double));
    for (uint32_t i = 0; i < valid; ++i) give_pair(block, first + i, honest_pair(self, buffer[i]));
  }
}

POTENTIAL(honest_create, honest_destroy, compute)
