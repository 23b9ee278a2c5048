// One pass of a time step, how the workers run several, and the clock that tells what each pass costs.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "barrier.hpp"
#include "base/worker.hpp"

namespace rouleau::core {

/// What happens between the workers when one of them has ended a pass.
enum class Meeting {
  none,      ///< it goes on
  all,       ///< it waits until all have ended the pass
  announce,  ///< it goes on, but tells the others: a later pass has `await`
  await      ///< it waits until all have announced the end of that earlier pass
};

/// Every worker runs its share.
struct Pass {
  std::string name;  ///< passes under one name are phases of one
  std::function<void(Worker)> run;
  Meeting meeting = Meeting::all;
};

/// Wall-clock time of the passes of a step as one worker sees it, waiting for others included.
class PassClock {
 public:
  explicit PassClock(std::size_t passes) : wall_s_(passes, 0.0) {}
  /// Time goes to no pass until now.
  void resume() { last_ = Clock::now(); }
  /// Time since the last call goes to this pass.
  void lap(std::size_t pass) {
    const Clock::time_point now = Clock::now();
    wall_s_[pass] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  /// What has gone to a pass since this was last asked.
  [[nodiscard]] double take(std::size_t pass) { return std::exchange(wall_s_[pass], 0.0); }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<double> wall_s_;
  Clock::time_point last_ = Clock::now();
};

/// What each worker does with the passes, in their order. The first worker's clock counts them from `first` on.
inline void run_passes(const std::vector<Pass>& passes, Worker worker, Barrier& barrier, PassClock& clock,
                       std::size_t first) {
  unsigned announced = 0;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    passes[i].run(worker);
    switch (passes[i].meeting) {
      case Meeting::all:
        barrier.arrive_and_wait();
        break;
      case Meeting::announce:
        announced = barrier.arrive();
        break;
      case Meeting::await:
        barrier.wait(announced);
        break;
      case Meeting::none:
        break;
    }
    if (worker.first()) clock.lap(first + i);
  }
}

}  // namespace rouleau::core
