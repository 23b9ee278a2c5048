// Fault: compiled with a later header, it reads an appended field of the setup without looking at struct_size.
#include "potential.h"

typedef struct later_setup {
  rouleau_setup known;
  double appended;
} later_setup;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const volatile double appended = ((const later_setup*)setup)->appended;
  (void)appended;
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
