/* Stands before the C library's allocator (LD_PRELOAD) and refuses one request, counted from 1:
 *   FAILING_ALLOCATION=N    the N-th, and no other
 *   FAILING_ALLOCATION=0    none; at the end ALLOCATION_PLACES gets a line "N" for each request whose callers differ
 *                           from those of all requests before, and last the number of requests
 * Requests before the program's main() are not counted: the loader and the libraries' own beginnings come first. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

enum { PLACES = 1 << 16, DEPTH = 10 };
static atomic_long requests, failing = -1; /* -1: main() has not begun */
static uint64_t seen[PLACES];
static long first_request[PLACES];
static atomic_long places;
static __thread int looking;

static void note(long request) {
  void* callers[DEPTH];
  uint64_t hash = 1469598103934665603u;
  looking = 1;
  const int depth = backtrace(callers, DEPTH);
  looking = 0;
  for (int i = 2; i < depth; ++i) hash = (hash ^ (uintptr_t)callers[i]) * 1099511628211u;
  for (uint64_t at = hash % PLACES;; at = (at + 1) % PLACES) {
    if (seen[at] == hash) return;
    if (seen[at] != 0) continue;
    seen[at] = hash;
    first_request[atomic_fetch_add(&places, 1)] = request;
    return;
  }
}

static int refused(void) {
  if (looking || failing < 0) return 0;
  const long request = atomic_fetch_add(&requests, 1) + 1;
  if (failing == 0) note(request);
  if (request != failing) return 0;
  errno = ENOMEM;
  return 1;
}

void* malloc(size_t size) { return refused() ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return refused() ? NULL : __libc_calloc(count, size); }
void* realloc(void* old, size_t size) { return refused() ? NULL : __libc_realloc(old, size); }
void* memalign(size_t alignment, size_t size) { return refused() ? NULL : __libc_memalign(alignment, size); }
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** out, size_t alignment, size_t size) {
  void* const memory = memalign(alignment, size);
  if (memory == NULL) return ENOMEM;
  *out = memory;
  return 0;
}

static void write_places(void) {
  const char* const file = getenv("ALLOCATION_PLACES");
  failing = -1;
  if (file == NULL) return;
  FILE* const out = fopen(file, "w");
  if (out == NULL) return;
  for (long i = 0; i < places; ++i) fprintf(out, "%ld\n", first_request[i]);
  fprintf(out, "%ld\n", requests);
  fclose(out);
}

/* The C library calls this with main: the last moment before the program's own first line. */
typedef int (*Main)(int, char**, char**);
static Main program;
static int counted_main(int count, char** words, char** environment) {
  void* callers[2];
  backtrace(callers, 2); /* loads what it needs */
  const char* const wanted = getenv("FAILING_ALLOCATION");
  if (wanted != NULL) failing = strtol(wanted, NULL, 10);
  if (failing == 0) atexit(write_places);
  return program(count, words, environment);
}
int __libc_start_main(Main main, int count, char** words, void (*init)(void), void (*fini)(void), void (*rtld)(void),
                      void* stack) {
  typedef int (*Start)(Main, int, char**, void (*)(void), void (*)(void), void (*)(void), void*);
  program = main;
  return ((Start)(intptr_t)dlsym(RTLD_NEXT, "__libc_start_main"))(counted_main, count, words, init, fini, rtld, stack);
}
