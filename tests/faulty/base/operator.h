// An honest collision operator in plain C (single relaxation time, Guo's forcing); faulty plugins replace one piece.
// A node is computed in double precision for both precisions of the lattice.
#ifndef ROULEAU_FAULTY_OPERATOR_H
#define ROULEAU_FAULTY_OPERATOR_H

#include "create.h"

typedef struct lattice {
  double c[19][3], weight[19], relaxation_rate;
  int inertia, dimension, count;
} lattice;

typedef struct node {
  double f[19], force[3], relaxation_rate;
} node;

typedef struct collided {
  double f[19], velocity[3];
} collided;

static inline void moments(const lattice* l, const node* n, double* density, double* velocity) {
  *density = 0;
  for (int k = 0; k < l->dimension; ++k) velocity[k] = n->force[k] / 2;
  for (int q = 0; q < l->count; ++q) {
    *density += n->f[q];
    for (int k = 0; k < l->dimension; ++k) velocity[k] += l->c[q][k] * n->f[q];
  }
}

static inline double dot(const lattice* l, const double* a, const double* b) {
  double sum = 0;
  for (int k = 0; k < l->dimension; ++k) sum += a[k] * b[k];
  return sum;
}

static inline double equilibrium(const lattice* l, int q, double density, const double* u) {
  const double along = dot(l, l->c[q], u);
  double value = density + 3 * along;
  if (l->inertia) value += 4.5 * along * along - 1.5 * dot(l, u, u);
  return l->weight[q] * value;
}

static inline double source(const lattice* l, int q, const double* force, const double* u) {
  const double along = dot(l, l->c[q], force);
  double value = 3 * along;
  if (l->inertia) value += 9 * along * dot(l, l->c[q], u) - 3 * dot(l, u, force);
  return l->weight[q] * value;
}

static inline collided honest_node(const lattice* l, const node* n) {
  collided after;
  double density;
  moments(l, n, &density, after.velocity);
  for (int q = 0; q < l->count; ++q) {
    after.f[q] = n->f[q] + n->relaxation_rate * (equilibrium(l, q, density, after.velocity) - n->f[q]) +
                 (1 - n->relaxation_rate / 2) * source(l, q, n->force, after.velocity);
  }
  return after;
}

/* One node of a block, in whichever precision. */
#define READ_NODE(block, x, l, n)                                                                                \
  do {                                                                                                           \
    for (int q = 0; q < (l)->count; ++q) (n).f[q] = (block)->in[q][x];                                           \
    for (int k = 0; k < (l)->dimension; ++k) (n).force[k] = (block)->force != NULL ? (block)->force[k][x] : 0;   \
    (n).relaxation_rate = (block)->relaxation_rate != NULL ? (block)->relaxation_rate[x] : (l)->relaxation_rate; \
  } while (0)
#define WRITE_NODE(type, block, x, l, after)                                      \
  do {                                                                            \
    for (int q = 0; q < (l)->count; ++q) (block)->out[q][x] = (type)(after).f[q]; \
    for (int k = 0; k < (l)->dimension && (block)->velocity != NULL; ++k) {       \
      (block)->velocity[k][x] = (type)(after).velocity[k];                        \
    }                                                                             \
  } while (0)

/* Every node of a block by a formula. */
static inline void collide_f64(collided (*formula)(const lattice*, const node*), const void* self,
                               const rouleau_collision_block_f64* block) {
  const lattice* l = (const lattice*)self;
  for (uint32_t x = 0; x < block->count; ++x) {
    node n;
    READ_NODE(block, x, l, n);
    const collided after = formula(l, &n);
    WRITE_NODE(double, block, x, l, after);
  }
}
static inline void collide_f32(collided (*formula)(const lattice*, const node*), const void* self,
                               const rouleau_collision_block_f32* block) {
  const lattice* l = (const lattice*)self;
  for (uint32_t x = 0; x < block->count; ++x) {
    node n;
    READ_NODE(block, x, l, n);
    const collided after = formula(l, &n);
    WRITE_NODE(float, block, x, l, after);
  }
}
static inline void honest_f64(const void* self, const rouleau_collision_block_f64* block) {
  collide_f64(honest_node, self, block);
}
static inline void honest_f32(const void* self, const rouleau_collision_block_f32* block) {
  collide_f32(honest_node, self, block);
}

static inline int honest_create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  lattice made = {0};
  made.dimension = (int)setup->dimension;
  made.count = (int)setup->velocity_count;
  if (!(made.dimension == 2 && made.count == 9) && !(made.dimension == 3 && made.count == 19)) {
    snprintf(error, error_size, "this operator is written for D2Q9 and D3Q19");
    return 1;
  }
  for (int q = 0; q < made.count; ++q) {
    memcpy(made.c[q], setup->velocities + made.dimension * q, sizeof(double) * (size_t)made.dimension);
    made.weight[q] = setup->weights[q];
  }
  made.relaxation_rate = setup->relaxation_rate;
  made.inertia = setup->inertia != 0;
  return keep(&made, sizeof made, self, error, error_size);
}

#define OPERATOR(create, destroy, f64, f32)                                                               \
  static const rouleau_collision functions = {sizeof functions, f64, f32};                                \
  static const rouleau_model model = {                                                                    \
      sizeof model, ROULEAU_COLLISION_KIND, PLUGIN_ID, "1.0.0", create, destroy, &functions, NULL, NULL}; \
  PLUGIN(model)
/* An operator whose nodes follow a formula of their own. */
#define OPERATOR_OF_NODES(formula)                                                                                   \
  static void f64(const void* self, const rouleau_collision_block_f64* block) { collide_f64(formula, self, block); } \
  static void f32(const void* self, const rouleau_collision_block_f32* block) { collide_f32(formula, self, block); } \
  OPERATOR(honest_create, honest_destroy, f64, f32)

#endif
