// Fault: keeps the last result under the distance that it belongs to, for each thread.
#include "potential.h"

static _Thread_local double last;
static _Thread_local pair kept;

static void compute(const void* self, const rouleau_interaction_block* block) {
  for (uint32_t i = 0; i < block->count; ++i) {
    if (block->distance[i] != last) {
      last = block->distance[i];
      kept = honest_pair((const potential*)self, last);
    }
    give_pair(block, i, kept);
  }
}

POTENTIAL(honest_create, honest_destroy, compute)
