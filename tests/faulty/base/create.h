// What every base shares: reading parameters in create, and the table that rouleau_open_v1 returns.
#ifndef ROULEAU_FAULTY_CREATE_H
#define ROULEAU_FAULTY_CREATE_H

#include <rouleau/plugin.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The parameter of that name, NULL where the host gave none. */
static inline const double* find_parameter(const rouleau_setup* setup, const char* name) {
  for (uint32_t i = 0; i < setup->parameter_count; ++i) {
    if (strcmp(setup->parameter_names[i], name) == 0) return &setup->parameter_values[i];
  }
  return NULL;
}

/* Returns 0, or writes the reason why the parameter is none that the bases can work with. */
static inline int read_positive(const rouleau_setup* setup, const char* name, double* value, char* error,
                                size_t error_size) {
  const double* found = find_parameter(setup, name);
  if (found != NULL && *found > 0 && *found < 1e300) {
    *value = *found;
    return 0;
  }
  snprintf(error, error_size, "%s must be a positive number", name);
  return 1;
}

/* An instance on the heap: a copy of `made`. */
static inline int keep(const void* made, size_t size, void** self, char* error, size_t error_size) {
  *self = malloc(size);
  if (*self == NULL) {
    snprintf(error, error_size, "no memory");
    return 1;
  }
  memcpy(*self, made, size);
  return 0;
}

static inline void honest_destroy(void* self) { free(self); }

/* The table of one model, and the function that gives it away. */
#define PLUGIN_TABLE(model)                                      \
  static const rouleau_model* const models[] = {&(model), NULL}; \
  static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};
#define PLUGIN(model)                                          \
  PLUGIN_TABLE(model)                                          \
  const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) { \
    (void)host_minor;                                          \
    return &plugin;                                            \
  }

#endif
