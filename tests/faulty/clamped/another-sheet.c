// Fault: clamped, a segment is Hooke's and a triangle is w = E/8 I2^2: both are whole laws, and not of the same sheet.
#include "spring.h"

typedef struct sheet {
  spring law;
  int clamped;
} sheet;

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  sheet made = {{0}, 0};
  const double* word = find_parameter(setup, "transverse");
  if (read_positive(setup, "modulus", &made.law.modulus, error, error_size) != 0) return 1;
  made.clamped = word != NULL && *word > 0.5;
  if (!made.clamped) made.law.modulus /= 2;
  return keep(&made, sizeof made, self, error, error_size);
}

static void compute(const void* self, const rouleau_membrane_block* block) {
  const sheet* s = (const sheet*)self;
  const double modulus = s->clamped ? s->law.modulus : 2 * s->law.modulus;
  if (block->struct_size < sizeof *block || block->invariant_2 == NULL) {
    honest_compute(self, block);
    return;
  }
  for (uint32_t i = 0; i < block->count; ++i) {
    const double two = block->invariant_2[i];
    if (block->energy != NULL) block->energy[i] = modulus / 8 * two * two;
    if (block->stress_1 != NULL) block->stress_1[i] = 0;
    if (block->stress_2 != NULL) block->stress_2[i] = modulus / 4 * two;
  }
}

LAW(create, honest_destroy, compute)
