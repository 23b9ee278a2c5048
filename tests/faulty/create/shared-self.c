// Fault: every instance is the same memory, so that the second one's parameters become the first one's.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  static potential only;
  if (read_positive(setup, "stiffness", &only.stiffness, error, error_size) != 0) return 1;
  if (read_positive(setup, "cutoff", &only.cutoff, error, error_size) != 0) return 1;
  *self = &only;
  return 0;
}

static void destroy(void* self) { (void)self; }

POTENTIAL(create, destroy, honest_compute)
