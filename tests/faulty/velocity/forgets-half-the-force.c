// Fault: the velocity that it gives lacks half the force.
#include "operator.h"

static collided hasty(const lattice* l, const node* n) {
  collided after = honest_node(l, n);
  for (int k = 0; k < 2; ++k) after.velocity[k] -= n->force[k] / 2;
  return after;
}

OPERATOR_OF_NODES(hasty)
