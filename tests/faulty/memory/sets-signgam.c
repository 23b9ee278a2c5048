// Fault: lgamma leaves a sign in a variable of the C library, which all threads share.
#include <math.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  volatile double x = 2.5;
  volatile double unused = lgamma(x);
  (void)unused;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
