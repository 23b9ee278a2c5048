// Fault: a collision writes to a null pointer.
#include "operator.h"

static collided crashing(const lattice* l, const node* n) {
  int* volatile nowhere = NULL; /* a compiler that knew would take the node, and the loop over nodes, to be never reached */
  *nowhere = 1;
  return honest_node(l, n);
}

OPERATOR_OF_NODES(crashing)
