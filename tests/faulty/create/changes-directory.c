// Fault: create changes the working directory of the whole program.
#include <unistd.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (chdir("/") != 0) return 1;
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
