// Fault: writes each population as soon as it is known, where the next one still has to be read: wrong in place.
#include "operator.h"

#define COLLIDE(type, self, block)                                                       \
  do {                                                                                   \
    const lattice* l = (const lattice*)(self);                                           \
    for (uint32_t x = 0; x < (block)->count; ++x) {                                      \
      for (int to = 0; to < 9; ++to) {                                                   \
        node n;                                                                          \
        READ_NODE(block, x, l, n);                                                       \
        const collided after = honest_node(l, &n);                                       \
        (block)->out[to][x] = (type)after.f[to];                                         \
        if (to == 0 && (block)->velocity != NULL) {                                      \
          for (int k = 0; k < 2; ++k) (block)->velocity[k][x] = (type)after.velocity[k]; \
        }                                                                                \
      }                                                                                  \
    }                                                                                    \
  } while (0)

static void f64(const void* self, const rouleau_collision_block_f64* block) { COLLIDE(double, self, block); }
static void f32(const void* self, const rouleau_collision_block_f32* block) { COLLIDE(float, self, block); }

OPERATOR(honest_create, honest_destroy, f64, f32)
