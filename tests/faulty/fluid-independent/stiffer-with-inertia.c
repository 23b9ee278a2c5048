// Fault: where the fluid has inertia it is stiffer, of which its manifest says nothing.
#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (honest_create(setup, self, error, error_size) != 0) return 1;
  if (setup->inertia != 0) ((potential*)*self)->stiffness *= 1.001;
  return 0;
}

POTENTIAL(create, honest_destroy, honest_compute)
