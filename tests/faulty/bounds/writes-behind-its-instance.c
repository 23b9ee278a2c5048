// Fault: allocates room for the first of its two members alone; what malloc adds hides it.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  void* made;
  if (honest_create(setup, &made, error, error_size) != 0) return 1;
  volatile size_t size = sizeof(double);
  *self = malloc(size);
  if (*self == NULL) return 1;
  memcpy(*self, made, sizeof(potential));
  free(made);
  return 0;
}

POTENTIAL(create, honest_destroy, honest_compute)
