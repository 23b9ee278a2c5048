/* A host of the first release: knows nothing but the frozen header, and ends every struct and array at a page that must
 * not be touched, so that a model which looks for a field of a later release dies.
 *
 * usage: first_host LIBRARY      with the models of frozen-1.0/authors_code.cpp */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <rouleau/plugin.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { count = 5 }; /* not a multiple of any vector's length */

static int failures = 0;

static void check(const char* what, double found, double expected, double tolerance) {
  if (fabs(found - expected) <= tolerance * fmax(fabs(expected), 1)) return;
  ++failures;
  fprintf(stderr, "%s: %.17g instead of %.17g\n", what, found, expected);
}

/* Memory that ends where the next page must not be touched. */
static void* guarded(const void* content, size_t bytes) {
  const size_t page = (size_t)sysconf(_SC_PAGESIZE), room = (bytes + page - 1) / page * page;
  char* start = mmap(NULL, room + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (start == MAP_FAILED || mprotect(start + room, page, PROT_NONE) != 0) abort();
  return content != NULL ? memcpy(start + room - bytes, content, bytes) : start + room - bytes;
}

static double* values(double first, double step) {
  double* all = guarded(NULL, count * sizeof(double));
  for (int i = 0; i < count; ++i) all[i] = first + i * step;
  return all;
}

static const rouleau_model* find(const rouleau_plugin* plugin, const char* id) {
  for (const rouleau_model* const* model = plugin->models; *model != NULL; ++model) {
    if (strcmp((*model)->id, id) == 0) return *model;
  }
  fprintf(stderr, "no model %s\n", id);
  exit(1);
}

static void* make(const rouleau_model* model) {
  static const char* const names[] = {"other_rate", "strength", "range", "rate", "modulus", "viscosity"};
  static const double parameters[] = {0.9, 3, 2, 0.25, 4, 0.5};
  static const double velocities[18] = {0, 0, 1, 0, 0, 1, -1, 0, 0, -1, 1, 1, -1, 1, -1, -1, 1, -1};
  static const double weights[9] = {4. / 9, 1. / 9, 1. / 9, 1. / 9, 1. / 9, 1. / 36, 1. / 36, 1. / 36, 1. / 36};
  rouleau_setup setup;
  memset(&setup, 0, sizeof setup);
  setup.struct_size = sizeof setup;
  setup.parameter_count = sizeof names / sizeof names[0];
  setup.parameter_names = names;
  setup.parameter_values = parameters;
  setup.length_unit = setup.time_unit = setup.mass_unit = 1;
  setup.dimension = 2;
  setup.velocity_count = 9;
  setup.velocities = velocities;
  setup.weights = weights;
  setup.sound_speed_squared = 1. / 3;
  setup.relaxation_rate = 1.25;
  char* error = guarded(NULL, 256);
  void* self = NULL;
  if (model->create(guarded(&setup, sizeof setup), &self, error, 256) != 0) {
    fprintf(stderr, "%s: %s\n", model->id, error);
    exit(1);
  }
  return self;
}

/* Collision keeps the mass, adds the force to the momentum, and gives the velocity halfway. Populations are of the
 * order of 1e-2, and some thirty operations lead to a node's sums: 30 x 1e-2 x the unit round-off of the number. */
#define COLLIDE(name, block_type, function, number, tolerance)                                                 \
  static void name(const rouleau_model* model) {                                                               \
    static const int c[9][2] = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}; \
    number *in[9], *out[9], *force[2], *velocity[2];                                                           \
    for (int q = 0; q < 9; ++q) {                                                                              \
      in[q] = guarded(NULL, count * sizeof(number));                                                           \
      out[q] = guarded(NULL, count * sizeof(number));                                                          \
      for (int x = 0; x < count; ++x) in[q][x] = (number)(1e-3 * ((q * 7 + x * 3) % 11));                      \
    }                                                                                                          \
    for (int k = 0; k < 2; ++k) {                                                                              \
      force[k] = guarded(NULL, count * sizeof(number));                                                        \
      velocity[k] = guarded(NULL, count * sizeof(number));                                                     \
      for (int x = 0; x < count; ++x) force[k][x] = (number)(1e-4 * (x - 2 * k));                              \
    }                                                                                                          \
    block_type block;                                                                                          \
    memset(&block, 0, sizeof block);                                                                           \
    block.struct_size = sizeof block;                                                                          \
    block.count = count;                                                                                       \
    block.in = guarded(in, sizeof in);                                                                         \
    block.out = guarded(out, sizeof out);                                                                      \
    block.force = guarded(force, sizeof force);                                                                \
    block.velocity = guarded(velocity, sizeof velocity);                                                       \
    void* self = make(model);                                                                                  \
    model->collision->function(self, guarded(&block, sizeof block));                                           \
    model->destroy(self);                                                                                      \
    for (int x = 0; x < count; ++x) {                                                                          \
      double mass = 0, momentum[2] = {0, 0}, before[2] = {0, 0};                                               \
      for (int q = 0; q < 9; ++q) {                                                                            \
        mass += out[q][x] - in[q][x];                                                                          \
        for (int k = 0; k < 2; ++k) {                                                                          \
          momentum[k] += c[q][k] * (double)out[q][x];                                                          \
          before[k] += c[q][k] * (double)in[q][x];                                                             \
        }                                                                                                      \
      }                                                                                                        \
      check("mass", mass, 0, tolerance);                                                                       \
      for (int k = 0; k < 2; ++k) {                                                                            \
        check("momentum", momentum[k] - before[k], force[k][x], tolerance);                                    \
        check("velocity", velocity[k][x], before[k] + 0.5 * force[k][x], tolerance);                           \
      }                                                                                                        \
    }                                                                                                          \
  }
COLLIDE(collide_f64, rouleau_collision_block_f64, collide_f64, double, 5e-17)
COLLIDE(collide_f32, rouleau_collision_block_f32, collide_f32, float, 2e-8)

static void interact(const rouleau_plugin* plugin) {
  const rouleau_model* model = find(plugin, "org.example.potential");
  rouleau_interaction_block block;
  memset(&block, 0, sizeof block);
  block.struct_size = sizeof block;
  block.count = count;
  block.distance = values(0.5, 0.75);
  block.energy = values(0, 0);
  block.force = values(0, 0);
  block.force_by_distance = values(0, 0);
  void* self = make(model);
  check("cutoff", model->interaction->cutoff(self), 20, 0);
  model->interaction->compute(self, guarded(&block, sizeof block));
  model->destroy(self);
  for (int i = 0; i < count; ++i) {
    const double e = exp(-block.distance[i] / 2);
    check("energy", block.energy[i], 3 * e, 1e-15);
    check("force", block.force[i], 1.5 * e, 1e-15);
    check("force by distance", block.force_by_distance[i], -0.75 * e, 1e-15);
  }

  model = find(plugin, "org.example.bond");
  const double* before[2] = {values(0.1, 0.1), values(1, 1)};
  double* after[2] = {values(0, 0), values(0, 0)};
  block.time_step = 1;
  block.state = guarded(before, sizeof before);
  block.new_state = guarded(after, sizeof after);
  self = make(model);
  model->interaction->compute(self, guarded(&block, sizeof block));
  model->destroy(self);
  for (int i = 0; i < count; ++i) {
    check("bonds", after[0][i], before[0][i] + 0.25 * (1 - before[0][i]), 1e-15);
    check("age", after[1][i], before[1][i] + 1, 1e-15);
    check("force of bonds", block.force[i], -after[0][i] * block.distance[i], 1e-15);
    check("no derivative", block.force_by_distance[i], 0, 0);
  }
}

static rouleau_membrane_block elements(void) {
  rouleau_membrane_block block;
  memset(&block, 0, sizeof block);
  block.struct_size = sizeof block;
  block.count = count;
  block.time_step = 1;
  block.energy = values(0, 0);
  return block;
}

static void deform(const rouleau_plugin* plugin, const char* id, const rouleau_membrane_block* block) {
  const rouleau_model* model = find(plugin, id);
  void* self = make(model);
  model->membrane->compute(self, guarded(block, sizeof *block));
  model->destroy(self);
}

static void stretch(const rouleau_plugin* plugin) {
  rouleau_membrane_block block = elements();
  block.stretch = values(0.8, 0.1);
  block.stretch_rate = values(-0.2, 0.1);
  block.tension = values(0, 0);
  block.tension_by_stretch = values(0, 0);
  block.tension_by_rate = values(0, 0);
  deform(plugin, "org.example.segment", &block);
  for (int i = 0; i < count; ++i) {
    const double strain = block.stretch[i] - 1;
    check("tension", block.tension[i], 4 * strain + 0.5 * block.stretch_rate[i], 1e-15);
    check("energy of a segment", block.energy[i], 2 * strain * strain, 1e-15);
    check("tension by stretch", block.tension_by_stretch[i], 4, 0);
    check("tension by rate", block.tension_by_rate[i], 0.5, 0);
  }
  const double* before[1] = {values(1, 0.05)};
  double* after[1] = {values(0, 0)};
  block.state = guarded(before, sizeof before);
  block.new_state = guarded(after, sizeof after);
  block.time_step = 0.5;
  deform(plugin, "org.example.dashpot", &block);
  for (int i = 0; i < count; ++i) {
    check("dashpot", after[0][i], 0.5 * (before[0][i] + block.stretch[i]), 1e-15);
    check("tension of the dashpot", block.tension[i], block.stretch[i] - after[0][i], 1e-15);
  }
}

static void bend(const rouleau_plugin* plugin) {
  rouleau_membrane_block block = elements();
  block.curvature = values(-0.3, 0.2);
  block.rest_curvature = values(0.1, 0.01);
  block.moment = values(0, 0);
  block.moment_by_curvature = values(0, 0);
  deform(plugin, "org.example.vertex", &block);
  for (int i = 0; i < count; ++i) {
    const double change = block.curvature[i] - block.rest_curvature[i];
    check("moment", block.moment[i], 4 * change, 1e-15);
    check("energy of a node", block.energy[i], 2 * change * change, 1e-15);
    check("moment by curvature", block.moment_by_curvature[i], 4, 0);
  }
}

static void inflate(const rouleau_plugin* plugin) {
  rouleau_membrane_block block = elements();
  block.area = values(90, 5);
  block.rest_area = values(100, 0);
  block.perimeter = values(40, 1);
  block.rest_perimeter = values(40, 0);
  block.pressure = values(0, 0);
  block.perimeter_tension = values(0, 0);
  deform(plugin, "org.example.cell", &block);
  for (int i = 0; i < count; ++i) {
    const double excess = block.area[i] - block.rest_area[i];
    check("pressure", block.pressure[i], -4 * excess, 1e-15);
    check("energy of a cell", block.energy[i], 2 * excess * excess, 1e-15);
    check("perimeter tension", block.perimeter_tension[i], 0, 0);
  }
}

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  void* library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) {
    fprintf(stderr, "%s\n", dlerror());
    return 1;
  }
  rouleau_open_function open = NULL;
  void* symbol = dlsym(library, ROULEAU_OPEN_SYMBOL);
  memcpy(&open, &symbol, sizeof open); /* C has no cast from data to function */
  const rouleau_plugin* plugin = open(0);
  collide_f64(find(plugin, "org.example.operator"));
  collide_f32(find(plugin, "org.example.operator"));
  collide_f64(find(plugin, "org.example.plain-operator"));
  collide_f32(find(plugin, "org.example.plain-operator"));
  interact(plugin);
  stretch(plugin);
  bend(plugin);
  inflate(plugin);
  return failures == 0 ? 0 : 1;
}
