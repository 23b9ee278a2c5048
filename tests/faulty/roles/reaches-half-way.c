// Fault: ends at half of the distance whose role is the cutoff.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const int refused = honest_create(setup, self, error, error_size);
  if (refused == 0) ((potential*)*self)->cutoff /= 2;
  return refused;
}

POTENTIAL(create, honest_destroy, honest_compute)
