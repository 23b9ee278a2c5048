// Fault: keeps the quadratic terms of the equilibrium when the setup asks for flow without inertia.
#include "operator.h"

static collided convective(const lattice* l, const node* n) {
  lattice with_inertia = *l;
  with_inertia.inertia = 1;
  return honest_node(&with_inertia, n);
}

OPERATOR_OF_NODES(convective)
