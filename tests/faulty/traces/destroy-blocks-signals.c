// Fault: destroy blocks a signal.
#define _GNU_SOURCE
#include <signal.h>

#include "potential.h"

static void destroy(void* self) {
  sigset_t blocked;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  sigprocmask(SIG_BLOCK, &blocked, NULL);
  honest_destroy(self);
}

POTENTIAL(honest_create, destroy, honest_compute)
