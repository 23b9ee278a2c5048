// Fault: destroy pauses.
#define _GNU_SOURCE
#include <unistd.h>

#include "potential.h"

static void destroy(void* self) {
  usleep(1);
  honest_destroy(self);
}

POTENTIAL(honest_create, destroy, honest_compute)
