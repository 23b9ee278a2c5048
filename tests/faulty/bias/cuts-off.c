// Fault: digits that single precision has no room for are cut off, in place of rounding to the nearest.
#include <math.h>

#include "operator.h"

static float cut_off(double value) {
  const float nearest = (float)value;
  return fabs((double)nearest) > fabs(value) ? nextafterf(nearest, 0) : nearest;
}

static void f32(const void* self, const rouleau_collision_block_f32* block) {
  const lattice* l = (const lattice*)self;
  for (uint32_t x = 0; x < block->count; ++x) {
    node n;
    READ_NODE(block, x, l, n);
    const collided after = honest_node(l, &n);
    WRITE_NODE(float, block, x, l, after);
    for (int q = 0; q < 9; ++q) block->out[q][x] = cut_off(after.f[q]);
  }
}

OPERATOR(honest_create, honest_destroy, honest_f64, f32)
