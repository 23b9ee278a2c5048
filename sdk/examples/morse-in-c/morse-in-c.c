/* The Morse potential in plain C11: phi = De (s^2 - 2 s), s = exp(beta (r0 - r)); force 2 De beta s (s - 1).
 * Zhang, Johnson and Popel (J. Biomech. 41, 2008), eq. 5. All that it includes of the SDK is the interface itself. */
#include <math.h>
#include <rouleau/plugin.h>
#include <stdio.h>
#include <stdlib.h>

struct morse {
  double De, beta, r0, rc;
};

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  struct morse* model = setup->parameter_count == 4 ? malloc(sizeof *model) : NULL;
  if (model == NULL) {
    snprintf(error, error_size, "four parameters are wanted, and memory for them");
    return 1;
  }
  const double* value = setup->parameter_values; /* in the manifest's order, in lattice units */
  *model = (struct morse){value[0], value[1], value[2], value[3]};
  *self = model;
  return 0;
}

static double cutoff(const void* self) { return ((const struct morse*)self)->rc; }

static void compute(const void* self, const rouleau_interaction_block* block) {
  const struct morse m = *(const struct morse*)self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double s = exp(m.beta * (m.r0 - block->distance[i]));
    if (block->energy) block->energy[i] = m.De * s * (s - 2);
    if (block->force) block->force[i] = 2 * m.De * m.beta * s * (s - 1);
    if (block->force_by_distance) block->force_by_distance[i] = 2 * m.De * m.beta * m.beta * s * (1 - 2 * s);
  }
}

static const rouleau_interaction functions = {sizeof(rouleau_interaction), cutoff, compute};
static const rouleau_model model = {.struct_size = sizeof(rouleau_model),
                                    .kind = ROULEAU_INTERACTION_KIND,
                                    .id = "org.example.morse-in-c",
                                    .version = "1.0.0",
                                    .create = create,
                                    .destroy = free,
                                    .interaction = &functions};
static const rouleau_model* const models[] = {&model, NULL};
static const rouleau_plugin plugin = {sizeof(rouleau_plugin), ROULEAU_ABI_MINOR, models};

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return &plugin;
}
