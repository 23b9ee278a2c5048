/* The transport library of an MPI: compiled once against each mpi.h that there is. */
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

#include "table.h"

static rouleau_transport table;
static char name[MPI_MAX_LIBRARY_VERSION_STRING];
static MPI_Message found;
static int found_bytes;

static void* begin_to_send(int32_t to, int32_t kind, const void* bytes, uint64_t count) {
  MPI_Request* request = malloc(sizeof *request);
  if (request == NULL) return NULL;
  MPI_Isend(bytes, (int)count, MPI_BYTE, to, kind, MPI_COMM_WORLD, request);
  return request;
}

static int sent(void* sending) {
  MPI_Request* request = sending;
  int done = 0;
  MPI_Test(request, &done, MPI_STATUS_IGNORE);
  if (done) free(request);
  return done;
}

static int arrived(int32_t from, int32_t kind, int32_t* sender, uint64_t* count) {
  int there = 0;
  MPI_Status status;
  MPI_Improbe(from < 0 ? MPI_ANY_SOURCE : from, kind, MPI_COMM_WORLD, &there, &found, &status);
  if (!there) return 0;
  MPI_Get_count(&status, MPI_BYTE, &found_bytes);
  *sender = status.MPI_SOURCE;
  *count = (uint64_t)found_bytes;
  return 1;
}

static void take(void* bytes) { MPI_Mrecv(bytes, found_bytes, MPI_BYTE, &found, MPI_STATUS_IGNORE); }

static void finish(void) { MPI_Finalize(); }

static void give_up(int exit_code) { MPI_Abort(MPI_COMM_WORLD, exit_code); }

__attribute__((visibility("default"))) const rouleau_transport* rouleau_transport_open_v1(void);

const rouleau_transport* rouleau_transport_open_v1(void) {
  int granted = MPI_THREAD_SINGLE, rank = 0, ranks = 1, length = 0;
  if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &granted) != MPI_SUCCESS) return NULL;
  if (granted < MPI_THREAD_FUNNELED) return NULL;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  MPI_Get_library_version(name, &length);
  name[strcspn(name, ",\n")] = '\0'; /* what follows speaks of the machine that it was built on */
  const char mpich[] = "MPICH Version:\t";
  if (strncmp(name, mpich, sizeof mpich - 1) == 0) {
    memmove(name + strlen("MPICH "), name + sizeof mpich - 1, strlen(name) - (sizeof mpich - 1) + 1);
  }
  table = (rouleau_transport){.struct_size = sizeof table,
                              .version = ROULEAU_TRANSPORT_VERSION,
                              .rank = rank,
                              .ranks = ranks,
                              .library = name,
                              .send = begin_to_send,
                              .sent = sent,
                              .arrived = arrived,
                              .take = take,
                              .finish = finish,
                              .give_up = give_up};
  return &table;
}
