// Fault: create takes a signal that belongs to the program.
#include <signal.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  signal(SIGINT, SIG_IGN);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
