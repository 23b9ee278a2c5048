// Fault: the single-precision path was written by hand and relaxes a hundredth more slowly.
#include "operator.h"

static collided mistyped(const lattice* l, const node* n) {
  node slower = *n;
  slower.relaxation_rate *= 0.99;
  return honest_node(l, &slower);
}

static void f32(const void* self, const rouleau_collision_block_f32* block) { collide_f32(mistyped, self, block); }

OPERATOR(honest_create, honest_destroy, honest_f64, f32)
