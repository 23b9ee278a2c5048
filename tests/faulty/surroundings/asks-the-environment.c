// Fault: create asks for a variable of the environment.

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (getenv("STIFF_POTENTIAL") != NULL) return 1;
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
