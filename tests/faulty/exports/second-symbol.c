// Fault: exports a second function, which may take the place of another library's function of that name.
#include "potential.h"

ROULEAU_EXPORT int common_name(void);
int common_name(void) { return 1; }

POTENTIAL(honest_create, honest_destroy, honest_compute)
