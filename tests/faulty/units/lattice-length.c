// Fault: a length of one is meant to be a micrometre, and is one spacing of whatever lattice there is.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (honest_create(setup, self, error, error_size) != 0) return 1;
  potential* p = *self;
  const double micrometre = 1;
  p->stiffness *= 1 + 0.01 * micrometre / p->cutoff;
  return 0;
}

POTENTIAL(create, honest_destroy, honest_compute)
