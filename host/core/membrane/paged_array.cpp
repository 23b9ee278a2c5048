#include "paged_array.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace rouleau::core {

namespace {

/// What is smaller is taken from the heap, which may have to write zeros, and which sanitizers watch.
constexpr std::size_t large = std::size_t{1} << 16;

}  // namespace

std::unique_ptr<void, ReleasePages> take_pages(std::size_t bytes) {
  void* first = bytes < large ? std::calloc(bytes > 0 ? bytes : 1, 1)
                              : ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (first == nullptr || first == MAP_FAILED) throw std::bad_alloc();
  return {first, {bytes}};
}

void ReleasePages::operator()(void* first) const {
  if (bytes < large)
    std::free(first);
  else
    ::munmap(first, bytes);
}

void release_pages(void* first, std::size_t bytes, std::span<const Range> parts, std::size_t bytes_of_element) {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto start = reinterpret_cast<std::uintptr_t>(first);
  const auto advise = [&](std::uintptr_t begin, std::uintptr_t end, int advice) {
    begin = (begin + page - 1) / page * page, end = end / page * page;
    // Advice that is not taken costs memory, and nothing else.
    if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, advice);
  };
  if (!parts.empty()) advise(start, start + bytes, MADV_NOHUGEPAGE);
  for (const Range& part : parts) {
    advise(start + static_cast<std::uintptr_t>(part.begin) * bytes_of_element,
           start + std::min(bytes, static_cast<std::uintptr_t>(part.end) * bytes_of_element), MADV_DONTNEED);
  }
}

}  // namespace rouleau::core
