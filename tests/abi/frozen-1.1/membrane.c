/* Interface 1.1, kept as it was released: two laws of triangles in one library. Never to be changed (README.md).
 *
 *   frozen.elastic-surface  energy G/2 (I1 + 2 + 1/(I2 + 1) - 3) per rest area, neo-Hookean
 *   frozen.viscous-surface  Newtonian: one viscosity against shear, one against change of area */
#include <rouleau/plugin.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size, const char* const* names) {
  double* value = calloc(2, sizeof *value);
  if (value == NULL) {
    snprintf(error, error_size, "no memory");
    return 1;
  }
  for (int i = 0; names[i] != NULL; ++i) {
    uint32_t k = 0;
    while (k < setup->parameter_count && strcmp(setup->parameter_names[k], names[i]) != 0) ++k;
    if (k == setup->parameter_count) {
      snprintf(error, error_size, "the parameter %s is missing", names[i]);
      free(value);
      return 2;
    }
    value[i] = setup->parameter_values[k];
  }
  *self = value;
  return 0;
}

static int create_elastic(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  static const char* const names[] = {"modulus", NULL};
  return create(setup, self, error, error_size, names);
}
static int create_viscous(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  static const char* const names[] = {"viscosity", "area_viscosity", NULL};
  return create(setup, self, error, error_size, names);
}

static void compute_elastic(const void* self, const rouleau_membrane_block* block) {
  const double g = *(const double*)self;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double square = block->invariant_2[i] + 1; /* of the ratio of areas */
    if (block->stress_1 != NULL) block->stress_1[i] = g / 2;
    if (block->stress_2 != NULL) block->stress_2[i] = -g / 2 / (square * square);
    if (block->energy != NULL) block->energy[i] = g / 2 * (block->invariant_1[i] + 1 / square - 1);
    if (block->stress_1_by_1 != NULL) block->stress_1_by_1[i] = 0;
    if (block->stress_1_by_2 != NULL) block->stress_1_by_2[i] = 0;
    if (block->stress_2_by_2 != NULL) block->stress_2_by_2[i] = g / (square * square * square);
  }
}

static void compute_viscous(const void* self, const rouleau_membrane_block* block) {
  const double* p = self;
  for (uint32_t i = 0; i < block->count; ++i) {
    if (block->shear_viscosity != NULL) block->shear_viscosity[i] = p[0];
    if (block->area_viscosity != NULL) block->area_viscosity[i] = p[1];
  }
}

static const rouleau_membrane elastic_table = {sizeof elastic_table, compute_elastic};
static const rouleau_membrane viscous_table = {sizeof viscous_table, compute_viscous};
static const rouleau_model elastic = {sizeof elastic,     ROULEAU_MEMBRANE_KIND, "frozen.elastic-surface",
                                      "1.0.0",            create_elastic,        free,
                                      NULL,               &elastic_table,        NULL};
static const rouleau_model viscous = {sizeof viscous,     ROULEAU_MEMBRANE_KIND, "frozen.viscous-surface",
                                      "1.0.0",            create_viscous,        free,
                                      NULL,               &viscous_table,        NULL};
static const rouleau_model* const models[] = {&elastic, &viscous, NULL};
static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return &plugin;
}
