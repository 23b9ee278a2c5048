// Fault: takes a parameter that is not a number for an index into a table.
#include <math.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const double* stiffness = find_parameter(setup, "stiffness");
  const double* volatile table = NULL;
  if (stiffness != NULL && isnan(*stiffness) && *table > 0) return 1;
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
