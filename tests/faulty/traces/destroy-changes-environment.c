// Fault: destroy sets a variable of the environment.
#define _GNU_SOURCE
#include <stdlib.h>

#include "potential.h"

static void destroy(void* self) {
  setenv("ROULEAU_FAULT", "1", 1);
  honest_destroy(self);
}

POTENTIAL(honest_create, destroy, honest_compute)
