// Nothing is wrong with this law: what the faulty ones are compared with.
#include "maxwell.h"

LAW(honest_create, honest_destroy, honest_compute)
