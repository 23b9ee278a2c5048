// Fault: the stiffness depends on a variable of the environment.

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (honest_create(setup, self, error, error_size) != 0) return 1;
  if (getenv("STIFF_POTENTIAL") != NULL) ((potential*)*self)->stiffness *= 2;
  return 0;
}

POTENTIAL(create, honest_destroy, honest_compute)
