// Fault: relaxes a tenth more slowly than the host asks for, so that the fluid has another viscosity.
#include "operator.h"

static collided viscous(const lattice* l, const node* n) {
  node slower = *n;
  slower.relaxation_rate *= 0.9;
  return honest_node(l, &slower);
}

OPERATOR_OF_NODES(viscous)
