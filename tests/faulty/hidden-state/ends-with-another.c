// Fault: the end of an instance changes the one that was made last.
#include "potential.h"

static potential* newest;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (honest_create(setup, self, error, error_size) != 0) return 1;
  newest = *self;
  return 0;
}

static void destroy(void* self) {
  if (newest != NULL && newest != self) newest->stiffness *= 1.5;
  newest = NULL;
  free(self);
}

POTENTIAL(create, destroy, honest_compute)
