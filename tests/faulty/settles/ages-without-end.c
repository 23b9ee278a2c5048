// Fault: grows stiffer with time, however slowly, and never comes to an end.
#include "potential.h"

typedef struct ageing {
  potential now;
  double rate;
} ageing;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  ageing made;
  void* now;
  if (honest_create(setup, &now, error, error_size) != 0) return 1;
  made.now = *(const potential*)now;
  free(now);
  made.rate = 6e-8 * setup->time_unit;
  return keep(&made, sizeof made, self, error, error_size);
}

static void compute(const void* self, const rouleau_interaction_block* block) {
  const ageing* p = (const ageing*)self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double age = block->state[0][i] + p->rate * block->time_step;
    const potential older = {p->now.stiffness * (1 + age), p->now.cutoff};
    give_pair(block, i, honest_pair(&older, block->distance[i]));
    if (block->new_state != NULL) block->new_state[0][i] = age;
  }
}

POTENTIAL(create, honest_destroy, compute)
