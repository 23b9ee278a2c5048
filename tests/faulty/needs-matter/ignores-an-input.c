// Fault: its manifest declares the normal velocity, which the host then computes for nothing.
#include "potential.h"

POTENTIAL(honest_create, honest_destroy, honest_compute)
