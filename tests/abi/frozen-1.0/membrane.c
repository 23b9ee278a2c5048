/* Interface 1.0, kept as it was released: three membrane laws in one library. Never to be changed (README.md).
 *
 *   frozen.solid    segments: Hooke's law, a Maxwell branch whose dashpot is state, and a viscosity
 *     T = E (e - 1) + E1 (e - d) + mu de/dt,  dd/dt = (e - d)/tau; over a step the stretch e counts as constant
 *     energy (without the viscosity) E/2 (e - 1)^2 + E1/2 (e - d)^2
 *   frozen.bending  nodes: m = B (kappa - kappa0), energy B/2 (kappa - kappa0)^2
 *   frozen.cell     whole cells: energy K/2 (A - A0)^2 / A0 + L/2 (P - P0)^2 / P0 */
#include <math.h>
#include <rouleau/plugin.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct law {
  double value[4];
} law;

static int named(const rouleau_setup* setup, const char* name, double* value) {
  for (uint32_t i = 0; i < setup->parameter_count; ++i) {
    if (strcmp(setup->parameter_names[i], name) == 0) {
      *value = setup->parameter_values[i];
      return 1;
    }
  }
  return 0;
}

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size, const char* const* names) {
  law* made = calloc(1, sizeof *made);
  if (made == NULL) {
    snprintf(error, error_size, "no memory");
    return 1;
  }
  for (int i = 0; names[i] != NULL; ++i) {
    if (!named(setup, names[i], &made->value[i])) {
      snprintf(error, error_size, "the parameter %s is missing", names[i]);
      free(made);
      return 2;
    }
  }
  *self = made;
  return 0;
}

static int create_solid(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  static const char* const names[] = {"modulus", "branch_modulus", "relaxation_time", "viscosity", NULL};
  return create(setup, self, error, error_size, names);
}
static int create_bending(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  static const char* const names[] = {"modulus", NULL};
  return create(setup, self, error, error_size, names);
}
static int create_cell(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  static const char* const names[] = {"area_modulus", "perimeter_modulus", NULL};
  return create(setup, self, error, error_size, names);
}

static void compute_solid(const void* self, const rouleau_membrane_block* block) {
  const double* p = ((const law*)self)->value;
  const double kept = exp(-block->time_step / p[2]);
  for (uint32_t i = 0; i < block->count; ++i) {
    const double stretch = block->stretch[i], rate = block->stretch_rate[i];
    const double dashpot = block->state[0][i], gap = stretch - dashpot, branch = kept * gap;
    if (block->tension != NULL) block->tension[i] = p[0] * (stretch - 1) + p[1] * branch + p[3] * rate;
    if (block->energy != NULL) {
      block->energy[i] = 0.5 * p[0] * (stretch - 1) * (stretch - 1) + 0.5 * p[1] * branch * branch;
    }
    if (block->tension_by_stretch != NULL) block->tension_by_stretch[i] = p[0] + p[1] * kept;
    if (block->tension_by_rate != NULL) block->tension_by_rate[i] = p[3];
    if (block->new_state != NULL) block->new_state[0][i] = dashpot + (1 - kept) * gap;
  }
}

static void compute_bending(const void* self, const rouleau_membrane_block* block) {
  const double modulus = ((const law*)self)->value[0];
  for (uint32_t i = 0; i < block->count; ++i) {
    const double change = block->curvature[i] - block->rest_curvature[i];
    if (block->moment != NULL) block->moment[i] = modulus * change;
    if (block->energy != NULL) block->energy[i] = 0.5 * modulus * change * change;
    if (block->moment_by_curvature != NULL) block->moment_by_curvature[i] = modulus;
  }
}

static void compute_cell(const void* self, const rouleau_membrane_block* block) {
  const double* p = ((const law*)self)->value;
  for (uint32_t i = 0; i < block->count; ++i) {
    const double area = block->area[i] - block->rest_area[i];
    const double perimeter = block->perimeter[i] - block->rest_perimeter[i];
    const double by_area = p[0] * area / block->rest_area[i];
    const double by_perimeter = p[1] * perimeter / block->rest_perimeter[i];
    if (block->pressure != NULL) block->pressure[i] = -by_area;
    if (block->perimeter_tension != NULL) block->perimeter_tension[i] = by_perimeter;
    if (block->energy != NULL) block->energy[i] = 0.5 * (by_area * area + by_perimeter * perimeter);
  }
}

static const rouleau_membrane solid_table = {sizeof solid_table, compute_solid};
static const rouleau_membrane bending_table = {sizeof bending_table, compute_bending};
static const rouleau_membrane cell_table = {sizeof cell_table, compute_cell};
static const rouleau_model solid = {
    sizeof solid, ROULEAU_MEMBRANE_KIND, "frozen.solid", "1.0.0", create_solid, free, NULL, &solid_table, NULL};
static const rouleau_model bending = {
    sizeof bending, ROULEAU_MEMBRANE_KIND, "frozen.bending", "1.0.0", create_bending, free, NULL, &bending_table, NULL};
static const rouleau_model cell = {
    sizeof cell, ROULEAU_MEMBRANE_KIND, "frozen.cell", "1.0.0", create_cell, free, NULL, &cell_table, NULL};
static const rouleau_model* const models[] = {&solid, &bending, &cell, NULL};
static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return &plugin;
}
