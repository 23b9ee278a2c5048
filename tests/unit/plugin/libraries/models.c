/* One library with a good model and one for each way in which a table can disagree with its manifest. */
#include <math.h>
#include <rouleau/plugin.h>
#include <stdio.h>
#include <string.h>

enum { echoed_parameters = 8 };

/* What create was told, so that a test can look at it through self. */
typedef struct echo {
  double values[echoed_parameters];
  double relaxation_rate, length_unit;
} echo;

static echo last;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  (void)error;
  (void)error_size;
  memset(&last, 0, sizeof last);
  for (uint32_t i = 0; i < setup->parameter_count && i < echoed_parameters; ++i) {
    last.values[i] = setup->parameter_values[i];
  }
  last.relaxation_rate = setup->relaxation_rate;
  last.length_unit = setup->length_unit;
  *self = &last;
  return 0;
}
static int create_fails(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  (void)setup;
  (void)self;
  snprintf(error, error_size, "the depth is too deep");
  return 1;
}
static int create_fails_unterminated(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  (void)setup;
  (void)self;
  memset(error, 'x', error_size);
  return 1;
}
static int create_fails_silently(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  (void)setup;
  (void)self;
  (void)error;
  (void)error_size;
  return 7;
}
static void destroy(void* self) { (void)self; }

static double cutoff(const void* self) { return self == NULL ? 0 : 1; }
static double endless(const void* self) { return self == NULL ? 0 : HUGE_VAL; }
static void compute(const void* self, const rouleau_interaction_block* block) {
  (void)self;
  for (uint32_t i = 0; i < block->count; ++i) block->force[i] = block->distance[i];
}
static void compute_membrane(const void* self, const rouleau_membrane_block* block) {
  (void)self;
  (void)block;
}

static const rouleau_interaction table = {sizeof table, cutoff, compute};
static const rouleau_interaction small_table = {4, cutoff, compute};
static const rouleau_interaction half_table = {sizeof half_table, NULL, compute};
static const rouleau_interaction endless_table = {sizeof endless_table, endless, compute};
static const rouleau_membrane membrane_table = {sizeof membrane_table, compute_membrane};

#define MODEL(name, kind, id, version, create, destroy, membrane, interaction) \
  static const rouleau_model name = {sizeof name, kind, id, version, create, destroy, NULL, membrane, interaction}
#define INTERACTION ROULEAU_INTERACTION_KIND

MODEL(good, INTERACTION, "good", "1.0.0", create, destroy, NULL, &table);
MODEL(newer, INTERACTION, "newer", "1.0.1", create, destroy, NULL, &table);
MODEL(membrane, ROULEAU_MEMBRANE_KIND, "membrane", "1.0.0", create, destroy, &membrane_table, NULL);
MODEL(without_create, INTERACTION, "without-create", "1.0.0", NULL, destroy, NULL, &table);
MODEL(without_destroy, INTERACTION, "without-destroy", "1.0.0", create, NULL, NULL, &table);
MODEL(without_table, INTERACTION, "without-table", "1.0.0", create, destroy, NULL, NULL);
MODEL(two_tables, INTERACTION, "two-tables", "1.0.0", create, destroy, &membrane_table, &table);
MODEL(with_small_table, INTERACTION, "small-table", "1.0.0", create, destroy, NULL, &small_table);
MODEL(with_half_table, INTERACTION, "half-table", "1.0.0", create, destroy, NULL, &half_table);
MODEL(without_version, INTERACTION, "without-version", NULL, create, destroy, NULL, &table);
MODEL(failing, INTERACTION, "failing", "1.0.0", create_fails, destroy, NULL, &table);
MODEL(unterminated, INTERACTION, "unterminated", "1.0.0", create_fails_unterminated, destroy, NULL, &table);
MODEL(silent, INTERACTION, "silent", "1.0.0", create_fails_silently, destroy, NULL, &table);
MODEL(without_end, INTERACTION, "endless", "1.0.0", create, destroy, NULL, &endless_table);
static const rouleau_model small = {16, INTERACTION, "small", "1.0.0", create, destroy, NULL, NULL, &table};

/* The small one stands first: it must not be in the way of the others. */
static const rouleau_model* const models[] = {&small,
                                              &good,
                                              &newer,
                                              &membrane,
                                              &without_create,
                                              &without_destroy,
                                              &without_table,
                                              &two_tables,
                                              &with_small_table,
                                              &with_half_table,
                                              &without_version,
                                              &failing,
                                              &unterminated,
                                              &silent,
                                              &without_end,
                                              NULL};
static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};

const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  (void)host_minor;
  return &plugin;
}
