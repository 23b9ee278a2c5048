// Fault: its version is not that of its manifest.
#include "potential.h"

static const rouleau_interaction functions = {sizeof functions, honest_cutoff, honest_compute};
static const rouleau_model model = {
    sizeof model, ROULEAU_INTERACTION_KIND, PLUGIN_ID, "1.0.1", honest_create, honest_destroy, NULL, NULL, &functions};
PLUGIN(model)
