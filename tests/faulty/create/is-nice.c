// Fault: create lowers the priority of the program.
#define _GNU_SOURCE
#include <unistd.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (nice(1) < 0) abort();
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
