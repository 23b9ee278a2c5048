// Nothing is wrong with this operator: what the faulty ones are compared with.
#include "operator.h"

OPERATOR(honest_create, honest_destroy, honest_f64, honest_f32)
