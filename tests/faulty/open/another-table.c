// Fault: makes its table anew at each call, on the heap.
#include "potential.h"

POTENTIAL_MODEL(honest_create, honest_destroy, honest_compute)
PLUGIN_TABLE(model)

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  rouleau_plugin* copy = malloc(sizeof *copy);
  if (copy != NULL) *copy = plugin;
  (void)host_minor;
  return copy;
}
