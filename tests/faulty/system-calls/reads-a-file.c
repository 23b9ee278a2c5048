// Fault: create reads a file.
#define _GNU_SOURCE
#include <fcntl.h>
#include <unistd.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const int file = open("/proc/self/status", O_RDONLY | O_CLOEXEC);
  if (file >= 0) close(file);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
