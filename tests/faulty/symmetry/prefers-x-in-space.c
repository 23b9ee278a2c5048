// Fault: in three dimensions one of three moments of third order is relaxed at another rate than its images; in two it
// is honest.
#include "operator.h"

/* c_x (c_y^2 - c_z^2): no part of mass, momentum and stress, and zero in equilibrium. */
static double mode(const lattice* l, int q) { return l->c[q][0] * (l->c[q][1] * l->c[q][1] - l->c[q][2] * l->c[q][2]); }

static collided lopsided(const lattice* l, const node* n) {
  collided after = honest_node(l, n);
  double moment = 0;
  if (l->dimension == 2) return after;
  for (int q = 0; q < l->count; ++q) moment += mode(l, q) * n->f[q];
  for (int q = 0; q < l->count; ++q) after.f[q] += 0.1 * l->weight[q] * mode(l, q) * moment;
  return after;
}

OPERATOR_OF_NODES(lopsided)
