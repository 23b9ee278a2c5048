// Fault: writes to address 0 while it is loaded.
#include "potential.h"

__attribute__((constructor)) static void on_load(void) {
  volatile int* volatile nowhere = NULL;
  *nowhere = 1;
}

POTENTIAL(honest_create, honest_destroy, honest_compute)
