// Fault: create changes the environment of the whole program.
#define _POSIX_C_SOURCE 200809L
#include <stdlib.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  setenv("HOME", "/nowhere", 1);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
