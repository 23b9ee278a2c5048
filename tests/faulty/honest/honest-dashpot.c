// Nothing is wrong with this law: what the faulty ones are compared with.
#include "dashpot.h"

LAW(honest_create, honest_destroy, honest_compute)
