// Fault: ends the program while it is loaded, with all its handlers, as if all were well.
#include "potential.h"

__attribute__((constructor)) static void on_load(void) { exit(0); }

POTENTIAL(honest_create, honest_destroy, honest_compute)
