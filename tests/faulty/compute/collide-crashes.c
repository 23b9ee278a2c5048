// Fault: a collision writes to a null pointer.
#include "operator.h"

static collided crashing(const lattice* l, const node* n) {
  *(volatile int*)NULL = 1;
  return honest_node(l, n);
}

OPERATOR_OF_NODES(crashing)
