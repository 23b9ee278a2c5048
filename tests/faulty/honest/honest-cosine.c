// Nothing is wrong with this potential, whose terms cancel at the cutoff: phi = K rc^2/pi^2 (1 + cos(pi r/rc)).
#include <math.h>

#include "potential.h"

static pair cosine(const potential* p, double distance) {
  const double k = 3.14159265358979323846 / p->cutoff, angle = k * distance;
  const pair result = {p->stiffness / (k * k) * (1 + cos(angle)), p->stiffness / k * sin(angle),
                       p->stiffness * cos(angle)};
  return result;
}

static void compute(const void* self, const rouleau_interaction_block* block) { compute_pairs(cosine, self, block); }

POTENTIAL(honest_create, honest_destroy, compute)
