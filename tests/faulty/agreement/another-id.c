// Fault: the id in the library is not that of the manifest.
#include "potential.h"

static const rouleau_interaction functions = {sizeof functions, honest_cutoff, honest_compute};
static const rouleau_model model = {sizeof model,
                                    ROULEAU_INTERACTION_KIND,
                                    "the-name-before-the-paper",
                                    "1.0.0",
                                    honest_create,
                                    honest_destroy,
                                    NULL,
                                    NULL,
                                    &functions};
PLUGIN(model)
