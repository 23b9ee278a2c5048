// Fault: the stiffness depends on where the library was loaded.
#include "potential.h"

static const double functions_of_no_use = 1;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (honest_create(setup, self, error, error_size) != 0) return 1;
  ((potential*)*self)->stiffness *= 1 + 1e-15 * (double)((uintptr_t)&functions_of_no_use >> 12 & 1023);
  return 0;
}

POTENTIAL(create, honest_destroy, honest_compute)
