// Fault: its manifest has a parameter, offset, that nothing depends on.
#include "potential.h"

POTENTIAL(honest_create, honest_destroy, honest_compute)
