// Fault: destroy opens a socket, and closes it.
#define _GNU_SOURCE
#include <sys/socket.h>
#include <unistd.h>

#include "potential.h"

static void destroy(void* self) {
  close(socket(AF_UNIX, SOCK_STREAM, 0));
  honest_destroy(self);
}

POTENTIAL(honest_create, destroy, honest_compute)
