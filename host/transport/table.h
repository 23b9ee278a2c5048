/* What the program and a transport library give each other: messages between the ranks of a run. The program has no
 * symbol of MPI; it opens one of the libraries that mpi.c is compiled into, and only where a launcher has started
 * several ranks. All functions belong to the thread that has opened the library. What MPI itself finds wrong ends the
 * job. */
#pragma once

/* NOLINTBEGIN: C, which C++ reads as well */
#include <stdint.h>

#define ROULEAU_TRANSPORT_VERSION 1

typedef struct rouleau_transport {
  uint32_t struct_size, version;
  int32_t rank, ranks;
  const char* library; /* "Open MPI v4.1.4", of one line */

  /* Begins to send at most 2^30 bytes, which stay where they are until sent() has said 1 of what this returns. Messages
   * of one kind from one rank to another arrive in their order. */
  void* (*send)(int32_t to, int32_t kind, const void* bytes, uint64_t count);
  /* Whether they may go; what send() returned has gone then. */
  int (*sent)(void* sending);
  /* Whether the next message of a kind from a rank (-1: from any) is there. If so, take() must follow. */
  int (*arrived)(int32_t from, int32_t kind, int32_t* sender, uint64_t* count);
  /* The message that arrived() has found. */
  void (*take)(void* bytes);

  /* The last call, by all ranks. */
  void (*finish)(void);
  /* Ends all ranks with this exit code. */
  void (*give_up)(int exit_code);
} rouleau_transport;

/* The one function of a library, rouleau_transport_open_v1: joins the other ranks. NULL: it cannot. */
typedef const rouleau_transport* (*rouleau_transport_open)(void);
/* NOLINTEND */
