// Fault: ends the process while it is loaded.
#include "potential.h"

__attribute__((constructor)) static void on_load(void) { abort(); }

POTENTIAL(honest_create, honest_destroy, honest_compute)
