// Fault: looks the stiffness up by distance, in a table that ends at four cutoffs, and does not look whether it ends.
#include <math.h>

#include "potential.h"

enum { intervals = 1024 };
typedef struct layered {
  potential outer;
  double stiffness[intervals];
} layered;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  layered made;
  if (read_positive(setup, "stiffness", &made.outer.stiffness, error, error_size) != 0) return 1;
  if (read_positive(setup, "cutoff", &made.outer.cutoff, error, error_size) != 0) return 1;
  for (int i = 0; i < intervals; ++i) made.stiffness[i] = made.outer.stiffness;
  return keep(&made, sizeof made, self, error, error_size);
}

static void compute(const void* self, const rouleau_interaction_block* block) {
  const layered* l = self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double place = block->distance[i] / l->outer.cutoff * (intervals / 4);
    potential here = l->outer;
    if (isfinite(place) && place > 0) here.stiffness = l->stiffness[(int64_t)place];
    give_pair(block, i, honest_pair(&here, block->distance[i]));
  }
}

POTENTIAL(create, honest_destroy, compute)
