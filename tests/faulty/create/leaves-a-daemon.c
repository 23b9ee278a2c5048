// Fault: create leaves a process in a session of its own behind.
#define _GNU_SOURCE
#include <sys/wait.h>
#include <unistd.h>

#include "potential.h"

static int create(const rouleau_setup* setup, void** self, char* error, size_t error_size) {
  const pid_t child = fork();
  if (child == 0) {
    setsid();
    if (fork() == 0) {
      for (int file = 0; file < 64; ++file) close(file);
      sleep(1000);
    }
    _exit(0);
  }
  waitpid(child, NULL, 0);
  return honest_create(setup, self, error, error_size);
}

POTENTIAL(create, honest_destroy, honest_compute)
