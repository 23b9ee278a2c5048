// Fault: create ends the program as if all were well.
#include <stdlib.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  exit(0);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
