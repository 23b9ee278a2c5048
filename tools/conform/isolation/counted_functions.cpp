// Linked into conform-check only; left out of builds with sanitizers.
#include "counted_functions.hpp"

#include <dlfcn.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

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

constexpr std::size_t page = 4096;
constexpr std::size_t alignment_of_malloc = 16;
constexpr unsigned char untouched = 0xa5;  ///< what lies between a piece and its guard

std::byte* page_of(std::byte* memory) { return memory - reinterpret_cast<std::uintptr_t>(memory) % page; }

/// A piece for a model that ends, but for its alignment, where a page begins that cannot be accessed, with its size
/// before it; null when the pool is used up or not asked.
void* from_pool(std::size_t alignment, std::size_t size) {
  if (!counts.from_pool || rouleau::ForeignCall::current() == nullptr) return nullptr;
  if (alignment > page || size > page * page) return nullptr;
  alignment = std::max(alignment, alignment_of_malloc);
  const std::size_t room = (size + alignment - 1) / alignment * alignment;
  const std::size_t pages = (room + sizeof size + page - 1) / page;
  std::byte* const begin = counts.pool_next.fetch_add(static_cast<std::ptrdiff_t>((pages + 1) * page));
  std::byte* const guard = begin + pages * page;
  if (guard + page > counts.pool_end) return nullptr;
  mprotect(guard, page, PROT_NONE);
  std::byte* piece = guard - room;
  std::memset(piece + size, untouched, room - size);
  std::memcpy(piece - sizeof size, &size, sizeof size);
  return piece;
}

std::size_t size_of(void* memory) {
  if (!counts.is_of_pool(memory)) return malloc_usable_size(memory);
  std::size_t size = 0;
  std::memcpy(&size, static_cast<std::byte*>(memory) - sizeof size, sizeof size);
  return size;
}

/// Takes a piece away for good. A write so near to the guard that this has not seen it is made seen.
void release_to_pool(std::byte* memory) {
  std::byte* end = memory + size_of(memory);
  while (end != page_of(end) && *end == std::byte{untouched}) ++end;
  if (end != page_of(end)) *const_cast<volatile std::byte*>(page_of(end) + page) = std::byte{0};
  std::byte* const begin = page_of(memory - sizeof(std::size_t));
  mprotect(begin, static_cast<std::size_t>(end - begin), PROT_NONE);
}

/// Counts a piece, and fills it.
void* count_allocation(void* memory, std::size_t bytes) {
  if (memory == nullptr) return memory;
  counts.allocations.fetch_add(1, std::memory_order_relaxed);
  if (counts.fill >= 0) std::memset(memory, counts.fill, bytes);
  return memory;
}

}  // namespace

// The GNU C library offers its own functions under these names to programs that stand before them.
#pragma GCC visibility push(default)  // for plugins to find; functions that are hidden count nothing
extern "C" {
// NOLINTBEGIN(readability-identifier-naming)
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
// NOLINTEND(readability-identifier-naming)

void* memalign(std::size_t alignment, std::size_t size) {
  void* memory = from_pool(alignment, size);
  return count_allocation(memory != nullptr ? memory : __libc_memalign(alignment, size), size);
}
void* malloc(std::size_t size) {
  void* memory = from_pool(0, size);
  return count_allocation(memory != nullptr ? memory : __libc_malloc(size), size);
}
void* calloc(std::size_t count, std::size_t size) {
  void* memory = size == 0 || count <= ~std::size_t{0} / size ? from_pool(0, count * size) : nullptr;
  if (memory == nullptr) memory = __libc_calloc(count, size);
  if (memory != nullptr) counts.allocations.fetch_add(1, std::memory_order_relaxed);
  return memory;
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
  if (counts.is_of_pool(memory))
    release_to_pool(static_cast<std::byte*>(memory));
  else
    __libc_free(memory);
}
void* realloc(void* memory, std::size_t size) {
  if (memory == nullptr) return malloc(size);
  void* moved = size == 0 ? nullptr : malloc(size);
  if (moved != nullptr) std::memcpy(moved, memory, std::min(size_of(memory), size));
  if (moved != nullptr || size == 0) free(memory);
  return moved;
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static const auto get = reinterpret_cast<int (*)(clockid_t, timespec*)>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = get(clock, time);
  counts.clock_reads.fetch_add(1, std::memory_order_relaxed);
  if (result == 0) time->tv_sec += counts.clock_ahead_s;
  return result;
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
char* getenv(const char* name) noexcept {
  const std::size_t length = std::strlen(name);
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    if (std::strncmp(*entry, name, length) == 0 && (*entry)[length] == '=') return *entry + length + 1;
  }
  // What the SDK asks for itself, which a run obeys and notes, and what Fortran's library asks when it is loaded.
  const bool may_ask = std::strcmp(name, "ROULEAU_INSTRUCTION_SET") == 0 || std::strncmp(name, "GFORTRAN_", 9) == 0;
  return rouleau::ForeignCall::current() == nullptr || may_ask ? nullptr : const_cast<char*>(counts.variable);
}
char* secure_getenv(const char* name) noexcept { return getenv(name); }
}
#pragma GCC visibility pop
