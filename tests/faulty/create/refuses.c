// Fault: refuses the defaults of its own manifest.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  (void)setup, (void)self;
  snprintf(error, error_size, "the moon is in the wrong quarter");
  return 1;
}

POTENTIAL(create, honest_destroy, honest_compute)
