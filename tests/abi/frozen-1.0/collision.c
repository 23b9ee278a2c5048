/* Interface 1.0, kept as it was released: a collision operator in plain C. Never to be changed (README.md).
 *
 * Single relaxation time on whatever velocity set the setup describes, at most 27 velocities:
 *   f' = f - omega (f - f_eq) + (1 - omega/2) S
 *   f_eq = w (rho + c.u/s + [(c.u)^2/(2 s^2) - u^2/(2 s)]),  S = w (c.F/s + [(c.u)(c.F)/s^2 - u.F/s]),  s = c_s^2
 * where rho and f are deviations from rest, u = sum f c + F/2, and the brackets stand only with inertia. */
#include <rouleau/plugin.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { most_velocities = 27, most_dimensions = 3 };

typedef struct bgk {
  uint32_t dimension, velocity_count, inertia;
  double velocity[most_velocities][most_dimensions];
  double weight[most_velocities];
  double sound_speed_squared, relaxation_rate;
} bgk;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  if (setup->dimension > most_dimensions || setup->velocity_count > most_velocities) {
    snprintf(error, error_size, "at most %d dimensions and %d velocities", most_dimensions, most_velocities);
    return 1;
  }
  bgk* made = calloc(1, sizeof *made);
  if (made == NULL) {
    snprintf(error, error_size, "no memory");
    return 2;
  }
  made->dimension = setup->dimension;
  made->velocity_count = setup->velocity_count;
  made->inertia = setup->inertia;
  for (uint32_t q = 0; q < setup->velocity_count; ++q) {
    for (uint32_t k = 0; k < setup->dimension; ++k) {
      made->velocity[q][k] = setup->velocities[q * setup->dimension + k];
    }
    made->weight[q] = setup->weights[q];
  }
  made->sound_speed_squared = setup->sound_speed_squared;
  made->relaxation_rate = setup->relaxation_rate;
  *self = made;
  return 0;
}

/* One node: f becomes f', and u the velocity. */
static void collide_node(const bgk* self, double omega, const double* force, double* f, double* u) {
  const double s = self->sound_speed_squared;
  double density = 0, u_u = 0, u_force = 0;
  for (uint32_t k = 0; k < self->dimension; ++k) u[k] = 0.5 * force[k];
  for (uint32_t q = 0; q < self->velocity_count; ++q) {
    density += f[q];
    for (uint32_t k = 0; k < self->dimension; ++k) u[k] += f[q] * self->velocity[q][k];
  }
  for (uint32_t k = 0; k < self->dimension; ++k) {
    u_u += u[k] * u[k];
    u_force += u[k] * force[k];
  }
  for (uint32_t q = 0; q < self->velocity_count; ++q) {
    double c_u = 0, c_force = 0;
    for (uint32_t k = 0; k < self->dimension; ++k) {
      c_u += self->velocity[q][k] * u[k];
      c_force += self->velocity[q][k] * force[k];
    }
    double equilibrium = density + c_u / s, source = c_force / s;
    if (self->inertia != 0) {
      equilibrium += 0.5 * c_u * c_u / (s * s) - 0.5 * u_u / s;
      source += c_u * c_force / (s * s) - u_force / s;
    }
    f[q] += omega * (self->weight[q] * equilibrium - f[q]) + (1 - 0.5 * omega) * self->weight[q] * source;
  }
}

#define COLLIDE(name, block_type, number)                                                   \
  static void name(const void* instance, const block_type* block) {                         \
    const bgk* self = instance;                                                             \
    for (uint32_t x = 0; x < block->count; ++x) {                                           \
      double f[most_velocities], force[most_dimensions] = {0}, u[most_dimensions];          \
      for (uint32_t q = 0; q < self->velocity_count; ++q) f[q] = block->in[q][x];           \
      for (uint32_t k = 0; block->force != NULL && k < self->dimension; ++k) {              \
        force[k] = block->force[k][x];                                                      \
      }                                                                                     \
      const double omega =                                                                  \
          block->relaxation_rate != NULL ? block->relaxation_rate[x] : self->relaxation_rate; \
      collide_node(self, omega, force, f, u);                                               \
      for (uint32_t q = 0; q < self->velocity_count; ++q) block->out[q][x] = (number)f[q];  \
      for (uint32_t k = 0; block->velocity != NULL && k < self->dimension; ++k) {           \
        block->velocity[k][x] = (number)u[k];                                               \
      }                                                                                     \
    }                                                                                       \
  }
COLLIDE(collide_f64, rouleau_collision_block_f64, double)
COLLIDE(collide_f32, rouleau_collision_block_f32, float)

static const rouleau_collision table = {sizeof table, collide_f64, collide_f32};
static const rouleau_model model = {
    sizeof model, ROULEAU_COLLISION_KIND, "frozen.bgk", "1.0.0", create, free, &table, NULL, NULL};
static const rouleau_model* const models[] = {&model, NULL};
static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return &plugin;
}
