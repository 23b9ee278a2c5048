// Fault: prints from compute, to standard output.
#include <unistd.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  static const char text[] = "computing\n";
  const ssize_t written = write(STDOUT_FILENO, text, sizeof text - 1);
  (void)written;
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
