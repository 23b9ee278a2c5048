// Fault: a collision writes to a null pointer.
#include "operator.h"

static collided crashing(const lattice* l, const node* n) {
  /* A compiler that saw the null pointer would take the loop over nodes for never reached. */
  volatile int* volatile nowhere = NULL;
  *nowhere = 1;
  return honest_node(l, n);
}

OPERATOR_OF_NODES(crashing)
