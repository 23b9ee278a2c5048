// The C library's functions that allocate and tell the time and the environment, as models meet them in the program of
// the checks: counted, guarded, and of another world where a check wants that.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace rouleau::conform {

struct ProcessCounts {
  std::atomic<std::int64_t> allocations{0}, releases{0};  ///< by malloc and its kin, and by new
  std::atomic<std::int64_t> clock_reads{0};               ///< by the C library's functions

  /// While `from_pool` is set, a model's memory is taken from this pool, with a guard behind each piece, and never
  /// given back to it: what is released cannot be accessed any more.
  std::atomic<bool> from_pool{false};
  std::byte *pool = nullptr, *pool_end = nullptr;
  std::atomic<std::byte*> pool_next{nullptr};
  [[nodiscard]] bool is_of_pool(const void* memory) const { return memory >= pool && memory < pool_end; }

  int fill = -1;  ///< bytes that memory is filled with when it is allocated and released; -1: it is not
  std::int64_t clock_ahead_s = 0;  ///< how much later it seems to be
  const char* variable = nullptr;  ///< what a model finds in every variable of the environment that there is not
};

/// Set by the program that counts; null where nothing does (builds with sanitizers, which have their own malloc).
inline ProcessCounts* process_counts = nullptr;

}  // namespace rouleau::conform
