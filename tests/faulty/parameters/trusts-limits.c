// Fault: relies on the host to keep a value within its limits, and ends the process when it does not.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const double* cutoff = find_parameter(setup, "cutoff");
  if (cutoff != NULL && *cutoff <= 0) abort();
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
