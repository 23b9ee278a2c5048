// Fault: on D3Q19 the velocity is written though the host does not want it.
#include "operator.h"

static void f64(const void* self, const rouleau_collision_block_f64* block) {
  const lattice* l = (const lattice*)self;
  collide_f64(honest_node, self, block);
  for (int k = 0; k < l->dimension && l->dimension == 3; ++k) block->velocity[k][0] += 0;
}

OPERATOR(honest_create, honest_destroy, f64, honest_f32)
