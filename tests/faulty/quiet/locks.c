// Fault: takes a lock in compute.
#include <pthread.h>

#include "potential.h"

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

static void compute(const void* self, const rouleau_interaction_block* block) {
  pthread_mutex_lock(&mutex);
  honest_compute(self, block);
  pthread_mutex_unlock(&mutex);
}

POTENTIAL(honest_create, honest_destroy, compute)
