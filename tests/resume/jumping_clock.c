// The wall clock as a careless administrator sets it: every look finds another century. The steady clock stays.
#define _GNU_SOURCE
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static long jumps;

static long jump(void) { return 3000000000L * (++jumps % 7 + 1); }

__attribute__((visibility("default"))) int clock_gettime(clockid_t clock, struct timespec* now) {
  const int status = (int)syscall(SYS_clock_gettime, clock, now);
  if (status == 0 && clock == CLOCK_REALTIME) now->tv_sec += jump();
  return status;
}

__attribute__((visibility("default"))) time_t time(time_t* where) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (where) *where = now.tv_sec;
  return now.tv_sec;
}
