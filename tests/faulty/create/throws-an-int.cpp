// Fault: something that is no exception leaves create, through a C interface.
#include "potential.h"

static int create(const rouleau_setup*, void**, char*, size_t) { throw 42; }

POTENTIAL(create, honest_destroy, honest_compute)
