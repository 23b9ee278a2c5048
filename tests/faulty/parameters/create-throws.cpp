// Fault: an exception leaves create when a value is outside its limits.
#include <stdexcept>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const double* stiffness = find_parameter(setup, "stiffness");
  if (stiffness != nullptr && *stiffness <= 0) throw std::invalid_argument("stiffness must be positive");
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
