// Fault: compares the host's minor version for equality, so that the next release of the host cannot use it.
#include "potential.h"

POTENTIAL_MODEL(honest_create, honest_destroy, honest_compute)
PLUGIN_TABLE(model)

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) { return host_minor == ROULEAU_ABI_MINOR ? &plugin : NULL; }
