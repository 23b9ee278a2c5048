// Fault: create makes a table that destroy does not free.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  char* volatile table = malloc(4096);
  if (table != NULL) memset(table, 1, 4096);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
