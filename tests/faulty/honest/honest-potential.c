// Nothing is wrong with this potential: what the faulty ones are compared with.
#include "potential.h"

POTENTIAL(honest_create, honest_destroy, honest_compute)
