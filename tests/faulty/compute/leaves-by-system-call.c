// Fault: compute ends the process by a system call.
#define _GNU_SOURCE
#include <sys/syscall.h>
#include <unistd.h>

#include "potential.h"

static void compute(const void* self, const rouleau_interaction_block* block) {
  syscall(SYS_exit_group, 0);
  honest_compute(self, block);
}

POTENTIAL(honest_create, honest_destroy, compute)
