// Fault: create changes the locale of the whole program.
#include <locale.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  setlocale(LC_ALL, "C.UTF-8");
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
