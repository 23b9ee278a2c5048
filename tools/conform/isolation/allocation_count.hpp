// What the C library's functions do for a model in the program of the checks, which stands before some of them: how
// often this process has allocated memory, taken locks and read the clock, where memory comes from, and what the world
// looks like.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace rouleau::conform {

struct ProcessCounts {
  std::atomic<std::int64_t> allocations{0}, releases{0};  ///< by malloc and its kin, and by new
  std::atomic<std::int64_t> locks{0};                     ///< mutexes and read-write locks taken
  std::atomic<std::int64_t> clock_reads{0};

  /// While `from_pool` is set, memory is taken from this pool, piece after piece, and never given back to it.
  std::atomic<bool> from_pool{false};
  std::atomic<bool> guarded{false};  ///< with a guard behind each piece; what is released cannot be accessed any more
  std::byte *pool = nullptr, *pool_end = nullptr;
  std::atomic<std::byte*> pool_next{nullptr};

  int fill = -1;  ///< bytes that memory is filled with when it is allocated and released; -1: it is not
  std::int64_t clock_ahead_s = 0;  ///< how much later it seems to be
  const char* variable = nullptr;  ///< what every variable of the environment seems to be that there is not
  char asked[64] = "";             ///< the first variable that a model has asked for after it was loaded
};

/// Set by the program that counts; null where nothing does (builds with sanitizers, which have their own malloc).
inline ProcessCounts* process_counts = nullptr;

}  // namespace rouleau::conform
