// Fault: ends the process with exit code 0 while it is loaded, as if all were well.
#include "potential.h"

__attribute__((constructor)) static void on_load(void) { _Exit(0); }

POTENTIAL(honest_create, honest_destroy, honest_compute)
