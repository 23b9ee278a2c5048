// Fault: seeds the random numbers of the C library, which are the whole program's.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  srand(1);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
