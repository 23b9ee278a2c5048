// Nothing is wrong with this potential: bonds of two states, weak ones that bind and turn strong under force, and both
// break the sooner the larger it is. Each rate acts alone for the step, one after the other (first order).
#include <math.h>

#include "potential.h"

typedef struct bonds {
  double stiffness, cutoff, rate, slip_force;
} bonds;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  bonds made;
  if (read_positive(setup, "stiffness", &made.stiffness, error, error_size) != 0) return 1;
  if (read_positive(setup, "cutoff", &made.cutoff, error, error_size) != 0) return 1;
  if (read_positive(setup, "rate", &made.rate, error, error_size) != 0) return 1;
  if (read_positive(setup, "slip_force", &made.slip_force, error, error_size) != 0) return 1;
  return keep(&made, sizeof made, self, error, error_size);
}

static void compute(const void* self, const rouleau_interaction_block* block) {
  const bonds* b = (const bonds*)self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double x = block->distance[i] - b->cutoff / 4, force = x > 0 ? b->stiffness * x : x == x ? 0 : x;
    const double size = force / b->slip_force, slip = exp(size > 200 ? 200 : size), dt = block->time_step;
    double weak = block->state[0][i], strong = block->state[1][i];
    const double turn = 3 * b->rate * (1 - exp(-size)), kept = exp(-(turn + b->rate) * dt), sum = weak + strong;
    strong = kept * strong + (1 - kept) * turn / (turn + b->rate) * sum;
    weak = kept * weak + (1 - kept) * b->rate / (turn + b->rate) * sum;
    strong *= exp(-0.1 * b->rate * slip * dt);
    const double change = b->rate * (1 + slip), left = exp(-change * dt), free_sites = strong < 1 ? 1 - strong : 0;
    weak = left * weak + (1 - left) * (b->rate / change) * free_sites;
    const pair result = {b->stiffness / 2 * (weak + strong) * x * x, -b->stiffness * (weak + strong) * x,
                         -b->stiffness * (weak + strong)};
    give_pair(block, i, result);
    if (block->new_state != NULL && block->new_state[0] != NULL) block->new_state[0][i] = weak;
    if (block->new_state != NULL && block->new_state[1] != NULL) block->new_state[1][i] = strong;
  }
}

POTENTIAL(create, honest_destroy, compute)
