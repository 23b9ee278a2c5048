// Stands before the C library's allocation and locking functions and counts their calls, in the program of the
// conformance checks only. Linked into no other program; left out of builds with sanitizers.
#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>
#include <cstddef>

#include "conform/allocation_count.hpp"

namespace {

rouleau::conform::ProcessCounts counts;

const bool registered = [] {
  rouleau::conform::process_counts = &counts;
  return true;
}();

void* count_allocation(void* memory) {
  if (memory != nullptr) counts.allocations.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// The GNU C library offers its own functions under these names to programs that stand before them.
#pragma GCC visibility push(default)  // for plugins to find; functions that are hidden count nothing
extern "C" {
// NOLINTBEGIN(readability-identifier-naming)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
// NOLINTEND(readability-identifier-naming)

void* malloc(std::size_t size) { return count_allocation(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) { return count_allocation(__libc_calloc(count, size)); }
void* memalign(std::size_t alignment, std::size_t size) { return count_allocation(__libc_memalign(alignment, size)); }
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
  if (memory != nullptr) counts.releases.fetch_add(1, std::memory_order_relaxed);
  __libc_free(memory);
}
void* realloc(void* memory, std::size_t size) {
  if (memory != nullptr) counts.releases.fetch_add(1, std::memory_order_relaxed);
  void* moved = __libc_realloc(memory, size);
  if (moved != nullptr || size != 0) counts.allocations.fetch_add(1, std::memory_order_relaxed);
  return moved;
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const auto lock = next<int (*)(pthread_mutex_t*)>("pthread_mutex_lock");
  counts.locks.fetch_add(1, std::memory_order_relaxed);
  return lock(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  static const auto lock = next<int (*)(pthread_mutex_t*)>("pthread_mutex_trylock");
  counts.locks.fetch_add(1, std::memory_order_relaxed);
  return lock(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* mutex) {
  static const auto lock = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  counts.locks.fetch_add(1, std::memory_order_relaxed);
  return lock(mutex);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* mutex) {
  static const auto lock = next<int (*)(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  counts.locks.fetch_add(1, std::memory_order_relaxed);
  return lock(mutex);
}
int pthread_spin_lock(pthread_spinlock_t* mutex) {
  static const auto lock = next<int (*)(pthread_spinlock_t*)>("pthread_spin_lock");
  counts.locks.fetch_add(1, std::memory_order_relaxed);
  return lock(mutex);
}
}
#pragma GCC visibility pop
