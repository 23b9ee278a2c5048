// Fault: writes a file when the program ends.
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdlib.h>

static void when_it_ends(void);

#include "potential.h"

__attribute__((constructor)) static void when_loaded(void) { atexit(when_it_ends); }

static void when_it_ends(void) {
  if (open("/dev/null", O_WRONLY | O_CLOEXEC) < 0) abort();
}

POTENTIAL(honest_create, honest_destroy, honest_compute)
