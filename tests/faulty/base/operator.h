// An honest collision operator in plain C (single relaxation time, Guo's forcing); faulty plugins replace one piece.
// A node is computed in double precision for both precisions of the lattice.
#ifndef ROULEAU_FAULTY_OPERATOR_H
#define ROULEAU_FAULTY_OPERATOR_H

#include "create.h"

typedef struct lattice {
  double c[9][2], weight[9], relaxation_rate;
  int inertia;
} lattice;

typedef struct node {
  double f[9], force[2], relaxation_rate;
} node;

typedef struct collided {
  double f[9], velocity[2];
} collided;

static inline void moments(const lattice* l, const node* n, double* density, double velocity[2]) {
  *density = 0;
  velocity[0] = n->force[0] / 2;
  velocity[1] = n->force[1] / 2;
  for (int q = 0; q < 9; ++q) {
    *density += n->f[q];
    velocity[0] += l->c[q][0] * n->f[q];
    velocity[1] += l->c[q][1] * n->f[q];
  }
}

static inline double equilibrium(const lattice* l, int q, double density, const double u[2]) {
  const double along = l->c[q][0] * u[0] + l->c[q][1] * u[1];
  double value = density + 3 * along;
  if (l->inertia) value += 4.5 * along * along - 1.5 * (u[0] * u[0] + u[1] * u[1]);
  return l->weight[q] * value;
}

static inline double source(const lattice* l, int q, const double force[2], const double u[2]) {
  const double along = l->c[q][0] * force[0] + l->c[q][1] * force[1];
  double value = 3 * along;
  if (l->inertia) {
    value += 9 * along * (l->c[q][0] * u[0] + l->c[q][1] * u[1]) - 3 * (u[0] * force[0] + u[1] * force[1]);
  }
  return l->weight[q] * value;
}

static inline collided honest_node(const lattice* l, const node* n) {
  collided after;
  double density;
  moments(l, n, &density, after.velocity);
  for (int q = 0; q < 9; ++q) {
    after.f[q] = n->f[q] + n->relaxation_rate * (equilibrium(l, q, density, after.velocity) - n->f[q]) +
                 (1 - n->relaxation_rate / 2) * source(l, q, n->force, after.velocity);
  }
  return after;
}

/* One node of a block, in whichever precision. */
#define READ_NODE(block, x, l, n)                                                                                \
  do {                                                                                                           \
    for (int q = 0; q < 9; ++q) (n).f[q] = (block)->in[q][x];                                                    \
    for (int k = 0; k < 2; ++k) (n).force[k] = (block)->force != NULL ? (block)->force[k][x] : 0;                \
    (n).relaxation_rate = (block)->relaxation_rate != NULL ? (block)->relaxation_rate[x] : (l)->relaxation_rate; \
  } while (0)
#define WRITE_NODE(type, block, x, after)                                \
  do {                                                                   \
    for (int q = 0; q < 9; ++q) (block)->out[q][x] = (type)(after).f[q]; \
    for (int k = 0; k < 2 && (block)->velocity != NULL; ++k) {           \
      (block)->velocity[k][x] = (type)(after).velocity[k];               \
    }                                                                    \
  } while (0)

/* Every node of a block by a formula. */
static inline void collide_f64(collided (*formula)(const lattice*, const node*), const void* self,
                               const rouleau_collision_block_f64* block) {
  const lattice* l = (const lattice*)self;
  for (uint32_t x = 0; x < block->count; ++x) {
    node n;
    READ_NODE(block, x, l, n);
    const collided after = formula(l, &n);
    WRITE_NODE(double, block, x, after);
  }
}
static inline void collide_f32(collided (*formula)(const lattice*, const node*), const void* self,
                               const rouleau_collision_block_f32* block) {
  const lattice* l = (const lattice*)self;
  for (uint32_t x = 0; x < block->count; ++x) {
    node n;
    READ_NODE(block, x, l, n);
    const collided after = formula(l, &n);
    WRITE_NODE(float, block, x, after);
  }
}
static inline void honest_f64(const void* self, const rouleau_collision_block_f64* block) {
  collide_f64(honest_node, self, block);
}
static inline void honest_f32(const void* self, const rouleau_collision_block_f32* block) {
  collide_f32(honest_node, self, block);
}

static inline int honest_create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  lattice made;
  if (setup->dimension != 2 || setup->velocity_count != 9) {
    snprintf(error, error_size, "this operator is written for D2Q9");
    return 1;
  }
  memcpy(made.c, setup->velocities, sizeof made.c);
  memcpy(made.weight, setup->weights, sizeof made.weight);
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
