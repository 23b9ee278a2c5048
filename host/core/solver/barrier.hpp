// Where the workers of a run wait for each other between two passes.
#pragma once

#include <atomic>
#include <thread>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace rouleau::core {

/// Barrier for a handful of threads that meet every few microseconds. It spins, since sleeping and waking takes longer
/// than most passes (OpenMP's barrier enters the kernel even for one thread), lets others run when it has spun in vain,
/// as two of our threads may share a core, and sleeps in the end: somebody may wait for another rank.
class Barrier {
 public:
  explicit Barrier(int workers) : workers_(workers) {}

  /// Thrown to who waits for a worker that has given up.
  struct Abandoned {};

  /// Returns when all workers have called it; what they wrote before is visible to all.
  void arrive_and_wait() { wait(arrive()); }

  /// The same in two halves, so that work which needs no other worker can stand between them: tells the others, and
  /// returns what wait() takes.
  [[nodiscard]] unsigned arrive() {
    if (workers_ == 1) return 0;
    const unsigned round = round_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == workers_) {
      arrived_.store(0, std::memory_order_relaxed);
      round_.store(round + 1, std::memory_order_release);
      round_.notify_all();
    }
    return round;
  }
  /// Returns when all workers have called arrive().
  void wait(unsigned round) {
    if (workers_ == 1) return;
    for (int spins = 0; round_.load(std::memory_order_acquire) == round; ++spins) {
      if (abandoned_.load(std::memory_order_relaxed)) throw Abandoned{};
      if (spins < patience) {
        pause();
      } else if (spins < patience + kindness) {
        std::this_thread::yield();
      } else {
        round_.wait(round, std::memory_order_acquire);
      }
    }
    if (abandoned_.load(std::memory_order_relaxed)) throw Abandoned{};  // that is how sleepers are woken
  }
  /// A worker will not come any more. Returns whether it is the first to say so.
  bool abandon() {
    const bool first = !abandoned_.exchange(true);
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
    return first;
  }

 private:
  static constexpr int patience = 1000, kindness = 100;
  static void pause() {
#if defined(__x86_64__)
    _mm_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
  }

  const int workers_;
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<unsigned> round_{0};
  std::atomic<bool> abandoned_{false};
};

}  // namespace rouleau::core
