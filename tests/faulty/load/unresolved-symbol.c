// Fault: calls a function that no library has.
#include "potential.h"

void function_that_nobody_wrote(void);

static void compute(const void* self, const rouleau_interaction_block* block) {
  function_that_nobody_wrote();
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
