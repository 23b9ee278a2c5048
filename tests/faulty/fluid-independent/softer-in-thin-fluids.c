// Fault: depends on the relaxation rate of the lattice, which is for collision operators.
#include "spring.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (honest_create(setup, self, error, error_size) != 0) return 1;
  if (setup->relaxation_rate > 1.2) ((spring*)*self)->modulus *= 0.5;
  return 0;
}

LAW(create, honest_destroy, honest_compute)
