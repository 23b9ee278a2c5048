// Fault: a thousandth of the resting population gets lost.
#include "operator.h"

static collided leaking(const lattice* l, const node* n) {
  collided after = honest_node(l, n);
  after.f[0] *= 0.999;
  return after;
}

OPERATOR_OF_NODES(leaking)
