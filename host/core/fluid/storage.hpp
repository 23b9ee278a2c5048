// Zeroed memory for lattice arrays: whole cache lines, and huge pages for large arrays where the system has them.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace rouleau::core {

/// `count` values of T, all zero. An array of at least half a huge page begins on one, so that a step over a lattice
/// that has left the cache does not miss the page tables too.
template <class T>
class Storage {
 public:
  Storage() = default;
  /// `in_parts`: some parts of it only will be touched, and no others take memory.
  explicit Storage(std::size_t count, bool in_parts = false) : count_(count) {
    const std::size_t alignment = 2 * bytes() >= huge_page && !in_parts ? huge_page : cache_line;
    std::size_t room = bytes() + alignment;
    zeros_.reset(std::calloc(room, 1));
    if (!zeros_) throw std::bad_alloc();
    void* begin = zeros_.get();
    data_ = static_cast<T*>(std::align(alignment, bytes(), begin, room));
#if defined(__linux__)
    if (alignment == huge_page) madvise(data_, bytes(), MADV_HUGEPAGE);
#endif
  }

  [[nodiscard]] T* data() const { return data_; }
  [[nodiscard]] std::size_t bytes() const { return sizeof(T) * count_; }

 private:
  static constexpr std::size_t cache_line = 64, huge_page = std::size_t{2} << 20;
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  std::size_t count_ = 0;
  std::unique_ptr<void, Free> zeros_;
  T* data_ = nullptr;
};

/// Asks for `count` values, soon to be read and written, to be brought into the second-level cache. Nothing waits for
/// them, and no address is wrong.
template <class T>
inline void fetch(const T* from, int count) {
  constexpr int line = 64 / sizeof(T);
  const T* const end = from + count + line;  // one line more: `from` may lie within one
  for (; from < end; from += line) __builtin_prefetch(from, 0, 2);
  // A function of nothing else has no effect, for all that g++ 12 knows, which then leaves its calls out.
  asm volatile("");  // NOLINT(hicpp-no-assembler)
}

}  // namespace rouleau::core
