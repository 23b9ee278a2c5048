// What a user sees while a run goes on: a bar on a terminal, a line now and then in a pipe.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace rouleau::run {

/// State of a run for display.
struct ProgressState {
  long step;
  double fraction;  ///< of the whole run that is done, estimated, 0..1
  std::string stage;
  double strain;
  double mach_max, area_drift;
  int rouleaux;           ///< of two cells or more; below 0: no cells attract each other, and nothing is said of them
  double steps_left = 0;  ///< at most; a stage that ends early takes none of what it had left
  const char* drifting = "area";  ///< or "volume"
};

/// What the rest takes at the speed of the steps so far; not a number before the first.
double remaining_s(const ProgressState& state, long steps_so_far, double seconds);

/// One line of at most `width` characters for a terminal. Where all of it has no room, what says least is left out:
/// first the Mach number, then the area drift, the speed, the rouleaux, and the bar after these.
/// rate: steps per second; remaining_s: not finite where it is not known.
std::string progress_line(const ProgressState& state, double rate, double remaining_s, std::size_t width);

/// Prints to stderr; cheap to call often: draws at most ten times a second (terminal) or every ten seconds (pipe).
class Progress {
 public:
  explicit Progress(bool quiet);
  void update(const ProgressState& state);
  /// Clears the bar's line: what is printed next starts on a clean one.
  void finish();

 private:
  bool quiet_, terminal_, drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
  long first_step_ = -1, last_step_ = 0;
  double rate_ = 0;  ///< steps per second, smoothed
};

}  // namespace rouleau::run
