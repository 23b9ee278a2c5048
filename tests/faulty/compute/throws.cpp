// Fault: an exception leaves compute, through a C interface.
#include <stdexcept>

#include "potential.h"

static void compute(const void*, const rouleau_interaction_block*) { throw std::runtime_error("out of range"); }

POTENTIAL(honest_create, honest_destroy, compute)
