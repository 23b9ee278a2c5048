// How often this process has allocated memory and taken locks. The program of the checks counts; other programs do not.
#pragma once

#include <atomic>
#include <cstdint>

namespace rouleau::conform {

struct ProcessCounts {
  std::atomic<std::int64_t> allocations{0}, releases{0};  ///< by malloc and its kin, and by new
  std::atomic<std::int64_t> locks{0};                     ///< mutexes and read-write locks taken
};

/// Set by the program that counts; null where nothing does (builds with sanitizers, which have their own malloc).
inline ProcessCounts* process_counts = nullptr;

}  // namespace rouleau::conform
