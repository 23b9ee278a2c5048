// Fault: says that it is a membrane law; its manifest and its functions are those of an interaction.
#include "potential.h"

static const rouleau_interaction functions = {sizeof functions, honest_cutoff, honest_compute};
static const rouleau_model model = {
    sizeof model, ROULEAU_MEMBRANE_KIND, PLUGIN_ID, "1.0.0", honest_create, honest_destroy, NULL, NULL, &functions};
PLUGIN(model)
