/* A law and a potential that take their parameters by place: a test's manifest may call them what it likes. */
#include <rouleau/plugin.h>
#include <stdlib.h>

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  double* values = calloc(setup->parameter_count + 1, sizeof *values);
  (void)error;
  (void)error_size;
  for (uint32_t i = 0; values != NULL && i < setup->parameter_count; ++i) values[i] = setup->parameter_values[i];
  *self = values;
  return values == NULL;
}

/* Tension 3 G (e - 1), with the first parameter as G. */
static void stretch(const void* self, const rouleau_membrane_block* block) {
  const double modulus = 3 * ((const double*)self)[0];
  for (uint32_t i = 0; i < block->count; ++i) {
    if (block->tension != NULL) block->tension[i] = modulus * (block->stretch[i] - 1);
    if (block->tension_by_stretch != NULL) block->tension_by_stretch[i] = modulus;
  }
}

/* Energy -D (1 - u^2)^2 with u from -1 in contact to 1 at the cutoff; D and the cutoff are the first two parameters. */
static double cutoff(const void* self) { return ((const double*)self)[1]; }
static void attract(const void* self, const rouleau_interaction_block* block) {
  const double depth = ((const double*)self)[0], end = cutoff(self);
  for (uint32_t i = 0; i < block->count; ++i) {
    const double u = block->distance[i] < end ? 2 * block->distance[i] / end - 1 : 1, rest = 1 - u * u;
    block->force[i] = -8 * depth / end * u * rest;
    if (block->energy != NULL) block->energy[i] = -depth * rest * rest;
  }
}

static const rouleau_membrane law_table = {sizeof law_table, stretch};
static const rouleau_interaction well_table = {sizeof well_table, cutoff, attract};
static const rouleau_model law = {
    sizeof law, ROULEAU_MEMBRANE_KIND, "org.example.law", "1.0.0", create, free, NULL, &law_table, NULL};
static const rouleau_model well = {
    sizeof well, ROULEAU_INTERACTION_KIND, "org.example.well", "1.0.0", create, free, NULL, NULL, &well_table};
static const rouleau_model* const models[] = {&law, &well, NULL};
static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return &plugin;
}
