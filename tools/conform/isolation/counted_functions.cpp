// Stands before the C library's functions that allocate, lock, and tell the time and the environment, in the program of
// the conformance checks only. Linked into no other program; left out of builds with sanitizers.
#include <dlfcn.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <ctime>

#include "allocation_count.hpp"
#include "base/foreign_call.hpp"

namespace {

rouleau::conform::ProcessCounts counts;

const bool registered = [] {
  constexpr std::size_t pool_size = std::size_t{1} << 30;  // of addresses; memory is there where it is used
  void* pool = mmap(nullptr, pool_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (pool != MAP_FAILED) {
    counts.pool_next = counts.pool = static_cast<std::byte*>(pool);
    counts.pool_end = counts.pool + pool_size;
  }
  rouleau::conform::process_counts = &counts;
  return true;
}();

bool is_of_pool(const void* memory) { return memory >= counts.pool && memory < counts.pool_end; }

constexpr std::size_t page = 4096;
constexpr unsigned char untouched = 0xa5;  ///< what lies between a piece and its guard

/// What stands before a piece of the pool.
struct PieceHeader {
  std::size_t size, pages;  ///< pages of its own, 0: it shares them
};

PieceHeader header_of(const void* memory) {
  PieceHeader header;
  std::memcpy(&header, static_cast<const std::byte*>(memory) - sizeof header, sizeof header);
  return header;
}

/// Takes bytes of the pool; null when it is used up.
std::byte* taken(std::size_t bytes) {
  std::byte* begin = counts.pool_next.fetch_add(static_cast<std::ptrdiff_t>(bytes));
  return begin + bytes >= counts.pool_end ? nullptr : begin;
}

/// A piece that ends, but for its alignment, where a page begins that cannot be accessed.
void* guarded_piece(std::size_t alignment, std::size_t size) {
  const std::size_t room = (size + alignment - 1) / alignment * alignment;
  const PieceHeader header = {size, (room + sizeof header + page - 1) / page};
  std::byte* begin = taken((header.pages + 2) * page);
  if (begin == nullptr) return nullptr;
  begin += (page - reinterpret_cast<std::uintptr_t>(begin) % page) % page;
  std::byte* guard = begin + header.pages * page;
  mprotect(guard, page, PROT_NONE);
  std::byte* piece = guard - room;
  std::memset(piece + size, untouched, room - size);
  std::memcpy(piece - sizeof header, &header, sizeof header);
  return piece;
}

/// A piece of the pool behind its header; null when the pool is used up or not asked.
void* from_pool(std::size_t alignment, std::size_t size) {
  if (!counts.from_pool) return nullptr;
  alignment = std::max<std::size_t>(alignment, 16);
  if (counts.guarded && alignment <= page && size < page * page) return guarded_piece(alignment, size);
  const std::size_t needed = size + 2 * alignment;
  if (needed < size || needed > static_cast<std::size_t>(counts.pool_end - counts.pool) / 2) return nullptr;
  std::byte* begin = taken((needed + 15) / 16 * 16);
  if (begin == nullptr) return nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  std::byte* piece = begin + ((address + 16 + alignment - 1) / alignment * alignment - address);
  const PieceHeader header = {size, 0};
  std::memcpy(piece - sizeof header, &header, sizeof header);
  return piece;
}

std::size_t size_of(void* memory) { return is_of_pool(memory) ? header_of(memory).size : malloc_usable_size(memory); }

/// Counts a piece, and fills what is new in it.
void* count_allocation(void* memory, std::size_t old_bytes, std::size_t bytes) {
  if (memory == nullptr) return memory;
  counts.allocations.fetch_add(1, std::memory_order_relaxed);
  if (counts.fill >= 0 && bytes > old_bytes) {
    std::memset(static_cast<std::byte*>(memory) + old_bytes, counts.fill, bytes - old_bytes);
  }
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

void* memalign(std::size_t alignment, std::size_t size) {
  void* memory = from_pool(alignment, size);
  return count_allocation(memory != nullptr ? memory : __libc_memalign(alignment, size), 0, size);
}
void* malloc(std::size_t size) {
  void* memory = from_pool(0, size);
  return count_allocation(memory != nullptr ? memory : __libc_malloc(size), 0, size);
}
void* calloc(std::size_t count, std::size_t size) {
  void* memory = size == 0 || count <= ~std::size_t{0} / size ? from_pool(0, count * size) : nullptr;
  return count_allocation(memory != nullptr ? memory : __libc_calloc(count, size), 0, 0);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
  if (memory == nullptr) return;
  counts.releases.fetch_add(1, std::memory_order_relaxed);
  if (counts.fill >= 0) std::memset(memory, counts.fill, size_of(memory));
  if (!is_of_pool(memory)) return __libc_free(memory);
  const auto [size, pages] = header_of(memory);
  if (pages == 0) return;  // it is never given back; with pages of its own nobody can access it any more
  auto* end = static_cast<std::byte*>(memory) + size;
  while (reinterpret_cast<std::uintptr_t>(end) % page != 0 && *end == std::byte{untouched}) ++end;
  if (reinterpret_cast<std::uintptr_t>(end) % page != 0) {  // written to, so near to the guard that it has not seen it
    auto* guard = reinterpret_cast<volatile std::byte*>((reinterpret_cast<std::uintptr_t>(end) / page + 1) * page);
    *guard = std::byte{0};
  }
  const auto address = reinterpret_cast<std::uintptr_t>(memory) - sizeof(PieceHeader);
  mprotect(reinterpret_cast<void*>(address / page * page), pages * page, PROT_NONE);
}
void* realloc(void* memory, std::size_t size) {
  if (memory == nullptr) return malloc(size);
  const std::size_t old_bytes = size_of(memory);
  if (is_of_pool(memory) || counts.from_pool) {
    void* moved = size == 0 ? nullptr : malloc(size);
    if (moved != nullptr) std::memcpy(moved, memory, std::min(old_bytes, size));
    if (moved != nullptr || size == 0) free(memory);
    return moved;
  }
  counts.releases.fetch_add(1, std::memory_order_relaxed);
  return count_allocation(__libc_realloc(memory, size), old_bytes, size);
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

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static const auto get = next<int (*)(clockid_t, timespec*)>("clock_gettime");
  counts.clock_reads.fetch_add(1, std::memory_order_relaxed);
  const int result = get(clock, time);
  if (result == 0) time->tv_sec += counts.clock_ahead_s;
  return result;
}
int timespec_get(timespec* time, int base) noexcept {
  return base == TIME_UTC && clock_gettime(CLOCK_REALTIME, time) == 0 ? base : 0;
}
int gettimeofday(timeval* time, void* /*zone*/) noexcept {
  timespec now{};
  const int result = clock_gettime(CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return result;
}
std::time_t time(std::time_t* time) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (time != nullptr) *time = now.tv_sec;
  return now.tv_sec;
}
std::clock_t clock() noexcept {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return now.tv_sec * CLOCKS_PER_SEC + now.tv_nsec / (1000000000 / CLOCKS_PER_SEC);
}
char* getenv(const char* name) noexcept {
  const rouleau::ForeignCall* foreign = rouleau::ForeignCall::current();
  // What the SDK asks for itself, which a run obeys and notes, and what Fortran's library does when it is loaded.
  if (std::strcmp(name, "ROULEAU_INSTRUCTION_SET") == 0 || std::strncmp(name, "GFORTRAN_", 9) == 0) foreign = nullptr;
  if (foreign != nullptr && std::strchr(foreign->function(), ' ') == nullptr && counts.asked[0] == '\0') {
    std::strncpy(counts.asked, name, sizeof counts.asked - 1);
  }
  const std::size_t length = std::strlen(name);
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    if (std::strncmp(*entry, name, length) == 0 && (*entry)[length] == '=') return *entry + length + 1;
  }
  return foreign != nullptr ? const_cast<char*>(counts.variable) : nullptr;
}
char* secure_getenv(const char* name) noexcept { return getenv(name); }
}
#pragma GCC visibility pop
