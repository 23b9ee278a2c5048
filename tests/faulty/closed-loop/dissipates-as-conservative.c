// Fault: of the manifest, which claims that a law with a dashpot is conservative.
#include "maxwell.h"

LAW(honest_create, honest_destroy, honest_compute)
