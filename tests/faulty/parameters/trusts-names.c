// Fault: reads a parameter without looking whether the host has it.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const double* volatile stiffness = find_parameter(setup, "stiffness");
  if (*stiffness <= 0) {
    snprintf(error, error_size, "stiffness must be positive");
    return 1;
  }
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
