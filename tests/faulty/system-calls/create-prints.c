// Fault: create prints.

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  printf("made with %u parameters\n", setup->parameter_count);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
