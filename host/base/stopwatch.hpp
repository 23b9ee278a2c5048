// Wall-clock time since a moment.
#pragma once

#include <chrono>

namespace rouleau {

/// Begins when it is made.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace rouleau
