// Fault: a hundredth of the force does not reach the fluid.
#include "operator.h"

static collided lazy(const lattice* l, const node* n) {
  collided after = honest_node(l, n);
  for (int q = 1; q < 9; ++q) {
    after.f[q] -= 0.01 * 3 * l->weight[q] * (l->c[q][0] * n->force[0] + l->c[q][1] * n->force[1]);
  }
  return after;
}

OPERATOR_OF_NODES(lazy)
