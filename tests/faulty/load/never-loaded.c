// Fault: loading it never ends.
#include "potential.h"

__attribute__((constructor)) static void on_load(void) {
  for (volatile int i = 0;; ++i) {
  }
}

POTENTIAL(honest_create, honest_destroy, honest_compute)
