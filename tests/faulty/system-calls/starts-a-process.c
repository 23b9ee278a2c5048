// Fault: create starts a process and waits for its end.
#define _GNU_SOURCE
#include <sys/wait.h>
#include <unistd.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, NULL, 0);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
