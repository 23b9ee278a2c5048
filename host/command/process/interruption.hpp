// Signals and a time limit ask a command to end in good order.
#pragma once

#include <atomic>
#include <string>

#include "base/stopwatch.hpp"

namespace rouleau::command {

/// The value of --max-time: wall-clock time from its construction on, none where the text is empty. Throws
/// Error(bad_input) where it is no time.
class TimeLimit {
 public:
  static constexpr const char* help = "stop after this time, as 110min, with everything written: for batch queues";
  explicit TimeLimit(const std::string& text);
  [[nodiscard]] bool is_set() const { return seconds_ > 0; }
  /// s; not above zero when it is over.
  [[nodiscard]] double left() const;

 private:
  double seconds_;
  Stopwatch watch_;
};

/// From now on Ctrl-C, SIGTERM, a closed terminal, what batch systems send before they kill (SIGUSR1, SIGXCPU), and the
/// end of the limit set the flag. A second Ctrl-C, SIGTERM or SIGHUP ends the
/// program at once; batch systems may repeat theirs. Signals that whoever started the program ignores stay ignored.
/// Throws Error(input_output) where the system has no timer.
const std::atomic<bool>& listen_for_interruption(const TimeLimit& limit);

/// What has set the flag: "Ctrl-C (SIGINT)", "--max-time", ...
std::string interruption_cause();

}  // namespace rouleau::command
