// Fault: compute reads the clock, which takes no system call.
#define _GNU_SOURCE
#include <time.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
