// Fault: a constructor reads a file, as the loader does.
#define _GNU_SOURCE
#include <fcntl.h>
#include <unistd.h>

#include "potential.h"

__attribute__((constructor)) static void when_loaded(void) {
  const int file = open("/proc/self/status", O_RDONLY | O_CLOEXEC);
  if (file >= 0) close(file);
}

POTENTIAL(honest_create, honest_destroy, honest_compute)
