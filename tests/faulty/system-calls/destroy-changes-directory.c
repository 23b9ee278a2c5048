// Fault: destroy changes the working directory, to what it is already.
#define _GNU_SOURCE
#include <unistd.h>

#include "potential.h"

static void destroy(void* self) {
  if (chdir(".") != 0) abort();
  honest_destroy(self);
}

POTENTIAL(honest_create, destroy, honest_compute)
