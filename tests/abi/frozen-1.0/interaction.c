/* Interface 1.0, kept as it was released: two interactions in one library. Never to be changed (README.md).
 *
 * frozen.brush: a brush of n chains per area and thickness L, in units of kT, with x = r/L:
 *   form "parabolic"    phi = n kT (1 - x)^2 for x < 1, beyond it nothing
 *   form "exponential"  phi = n kT exp(-x), cut off at 20 L
 * The state is the time since the surfaces came within the cutoff; nothing depends on it.
 *
 * frozen.damper: a force per area of -c dr/dt where r < R. */
#include <math.h>
#include <rouleau/plugin.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct brush {
  double strength, thickness;
  int exponential;
} brush;

typedef struct damper {
  double friction, range;
} damper;

static double named(const rouleau_setup* setup, const char* name) {
  for (uint32_t i = 0; i < setup->parameter_count; ++i) {
    if (strcmp(setup->parameter_names[i], name) == 0) return setup->parameter_values[i];
  }
  return NAN;
}

static int create_brush(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const double boltzmann = 1.380649e-23; /* J/K */
  /* The temperature arrives in SI, so kT is made in J and taken into lattice units here. */
  const double energy_unit =
      setup->mass_unit * setup->length_unit * setup->length_unit / (setup->time_unit * setup->time_unit);
  const double temperature = named(setup, "temperature"), form = named(setup, "form");
  brush* made = calloc(1, sizeof *made);
  if (made == NULL) {
    snprintf(error, error_size, "no memory");
    return 1;
  }
  made->strength = named(setup, "chains") * boltzmann * temperature / energy_unit;
  made->thickness = named(setup, "thickness");
  made->exponential = form == 1;
  if (!(isfinite(made->strength) && isfinite(made->thickness) && (form == 0 || form == 1))) {
    snprintf(error, error_size, "a parameter is missing");
    free(made);
    return 2;
  }
  *self = made;
  return 0;
}

static int create_damper(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  damper* made = calloc(1, sizeof *made);
  if (made == NULL) {
    snprintf(error, error_size, "no memory");
    return 1;
  }
  made->friction = named(setup, "friction");
  made->range = named(setup, "range");
  if (!(isfinite(made->friction) && isfinite(made->range))) {
    snprintf(error, error_size, "a parameter is missing");
    free(made);
    return 2;
  }
  *self = made;
  return 0;
}

static double range(const void* self) { return ((const damper*)self)->range; }

static void damp(const void* self, const rouleau_interaction_block* block) {
  const damper* d = self;
  for (uint32_t i = 0; i < block->count; ++i) {
    if (block->force == NULL) continue;
    block->force[i] = block->distance[i] < d->range ? -d->friction * block->normal_velocity[i] : 0;
  }
}

static double cutoff(const void* self) {
  const brush* b = self;
  return b->exponential ? 20 * b->thickness : b->thickness;
}

static void compute(const void* self, const rouleau_interaction_block* block) {
  const brush* b = self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double x = block->distance[i] / b->thickness;
    double energy = 0, force = 0, stiffness = 0; /* in units of strength, strength/L, strength/L^2 */
    if (b->exponential) {
      energy = force = exp(-x);
      stiffness = -energy;
    } else if (x < 1) {
      energy = (1 - x) * (1 - x);
      force = 2 * (1 - x);
      stiffness = -2;
    }
    if (block->energy != NULL) block->energy[i] = b->strength * energy;
    if (block->force != NULL) block->force[i] = b->strength / b->thickness * force;
    if (block->force_by_distance != NULL) {
      block->force_by_distance[i] = b->strength / (b->thickness * b->thickness) * stiffness;
    }
    if (block->new_state != NULL) block->new_state[0][i] = block->state[0][i] + block->time_step;
  }
}

static const rouleau_interaction brush_table = {sizeof brush_table, cutoff, compute};
static const rouleau_interaction damper_table = {sizeof damper_table, range, damp};
static const rouleau_model brush_model = {
    sizeof brush_model, ROULEAU_INTERACTION_KIND, "frozen.brush", "1.0.0", create_brush, free, NULL, NULL, &brush_table};
static const rouleau_model damper_model = {
    sizeof damper_model, ROULEAU_INTERACTION_KIND, "frozen.damper", "1.0.0", create_damper, free, NULL, NULL,
    &damper_table};
static const rouleau_model* const models[] = {&brush_model, &damper_model, NULL};
static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return &plugin;
}
