// Fault: the stiffness depends on the month.
#define _GNU_SOURCE
#include <time.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (honest_create(setup, self, error, error_size) != 0) return 1;
  ((potential*)*self)->stiffness *= 1 + 1e-15 * (double)(time(NULL) / 2600000 % 64);
  return 0;
}

POTENTIAL(create, honest_destroy, honest_compute)
