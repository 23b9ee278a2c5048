// Fault: of the manifest, whose reference energy is a hundredth too large.
#include "potential.h"

POTENTIAL(honest_create, honest_destroy, honest_compute)
