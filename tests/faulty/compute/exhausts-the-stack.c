// Fault: compute calls itself until the stack is exhausted.
#include "potential.h"

static uint32_t descend(uint32_t depth) {
  volatile uint32_t room[256];
  room[depth % 256] = depth;
  return depth == 0 ? 0 : descend(depth + 1) + room[depth % 256];
}

static void compute(const void* self, const rouleau_interaction_block* block) {
  if (descend(block->count) == 0) return;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
