// Two builds of one plugin as one: the honest one works in two dimensions, the mutant in three.
#include <rouleau/plugin.h>
#include <stdlib.h>
#include <string.h>

const rouleau_plugin* open_honest(uint32_t host_minor);
const rouleau_plugin* open_mutant(uint32_t host_minor);

typedef struct instance {
  const rouleau_model* model;
  void* self;
} instance;

static const rouleau_model *honest, *mutant;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  instance made = {setup->dimension == 3 ? mutant : honest, NULL};
  const int code = made.model->create(setup, &made.self, error, error_size);
  if (code != 0) return code;
  *self = malloc(sizeof made);
  memcpy(*self, &made, sizeof made);
  return 0;
}
static void destroy(void* self) {
  ((instance*)self)->model->destroy(((instance*)self)->self);
  free(self);
}
static double cutoff(const void* self) {
  const instance* of = self;
  return of->model->interaction->cutoff(of->self);
}
static void interact(const void* self, const rouleau_interaction_block* block) {
  const instance* of = self;
  of->model->interaction->compute(of->self, block);
}
static void membrane(const void* self, const rouleau_membrane_block* block) {
  const instance* of = self;
  of->model->membrane->compute(of->self, block);
}
static void collide_f64(const void* self, const rouleau_collision_block_f64* block) {
  const instance* of = self;
  of->model->collision->collide_f64(of->self, block);
}
static void collide_f32(const void* self, const rouleau_collision_block_f32* block) {
  const instance* of = self;
  of->model->collision->collide_f32(of->self, block);
}

static const rouleau_interaction interactions = {sizeof interactions, cutoff, interact};
static const rouleau_membrane membranes = {sizeof membranes, membrane};
static const rouleau_collision collisions = {sizeof collisions, collide_f64, collide_f32};
static rouleau_model model;
static const rouleau_model* const models[] = {&model, NULL};
static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};

ROULEAU_EXPORT const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) {
  const rouleau_plugin* both[] = {open_honest(host_minor), open_mutant(host_minor)};
  if (both[0] == NULL || both[1] == NULL) return NULL;
  honest = both[0]->models[0];
  mutant = both[1]->models[0];
  if (mutant->kind != honest->kind) return NULL;
  model = *honest;
  model.create = create;
  model.destroy = destroy;
  model.interaction = honest->interaction != NULL ? &interactions : NULL;
  model.membrane = honest->membrane != NULL ? &membranes : NULL;
  model.collision = honest->collision != NULL ? &collisions : NULL;
  return &plugin;
}
