// Fault: prints when the program ends.
#include <stdlib.h>

static void when_it_ends(void);

#include "potential.h"

__attribute__((constructor)) static void when_loaded(void) { atexit(when_it_ends); }

static void when_it_ends(void) { puts("the end"); }

POTENTIAL(honest_create, honest_destroy, honest_compute)
