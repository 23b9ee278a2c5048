// Fault: a member of the instance is what was in the memory before; in pieces that are always mapped anew that is 0.
#include "potential.h"

typedef struct large {
  potential made;
  double unset[1 << 22];  // glibc keeps freed pieces below 32 MiB
} large;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  void* made = NULL;
  if (honest_create(setup, &made, error, error_size) != 0) return 1;
  large* grown = malloc(sizeof(large));
  if (grown == NULL) abort();
  grown->made = *(const potential*)made;
  free(made);
  *self = grown;
  return 0;
}

static void compute(const void* self, const rouleau_interaction_block* block) {
  const volatile double* unset = &((const large*)self)->unset[1 << 21];
  honest_compute(self, block);
  if (*unset == 0) return;
  for (uint32_t i = 0; i < block->count && block->force != NULL; ++i) block->force[i] *= 2;
}

POTENTIAL(create, honest_destroy, compute)
