// Fault: its manifest claims a nanosecond for an element, which takes it two hundred steps of a loop.
#include "potential.h"

static pair slow(const potential* p, double distance) {
  for (volatile int i = 0; i < 200; ++i) {
  }
  return honest_pair(p, distance);
}

static void compute(const void* self, const rouleau_interaction_block* block) { compute_pairs(slow, self, block); }

POTENTIAL(honest_create, honest_destroy, compute)
