#include "output/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace rouleau::host {

namespace {

using Seconds = std::chrono::duration<double>;

template <class... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// "42 s", "3:07 min", "1:05 h": two parts are enough to decide whether to wait.
std::string duration(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0) return "?";
  const auto total = static_cast<long>(std::lround(std::min(seconds, 3.6e8)));
  if (total < 60) return formatted("%ld s", total);
  if (total < 3600) return formatted("%ld:%02ld min", total / 60, total % 60);
  return formatted("%ld:%02ld h", total / 3600, total / 60 % 60);
}

std::string bar(double fraction, int width) {
  const int done = static_cast<int>(std::lround(fraction * width));
  std::string text(static_cast<std::size_t>(width), ' ');
  std::fill_n(text.begin(), done, '=');
  if (done > 0 && done < width) text[static_cast<std::size_t>(done) - 1] = '>';
  return "[" + text + "]";
}

int terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

Progress::Progress(bool quiet)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()), last_(start_) {}

void Progress::update(const ProgressState& state) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!drawn_ && first_step_ < 0) {  // a resumed run begins at a later step; its speed must not count the earlier ones
    first_step_ = last_step_ = state.step;
    first_fraction_ = state.fraction;
  }
  const double since_last = Seconds(now - last_).count();
  if (since_last < (terminal_ ? 0.1 : 10.0)) return;

  const double elapsed = Seconds(now - start_).count();
  const double fraction = std::isfinite(state.fraction) ? std::clamp(state.fraction, 0.0, 1.0) : 0.0;
  const double gained = fraction - first_fraction_;
  const double remaining = gained > 0 ? elapsed * (1 - fraction) / gained : NAN;
  // The terminal shows the speed of the last second or so, a pipe that of the last line's interval.
  const double rate = static_cast<double>(state.step - last_step_) / since_last;
  rate_ = rate_ > 0 && terminal_ ? 0.9 * rate_ + 0.1 * rate : rate;
  last_ = now;
  last_step_ = state.step;

  const std::string numbers =
      formatted("%3.0f%%  ETA %s  strain %.2f  %.0f steps/s  Mach %.2g  area drift %.1e  %d aggregate%s",
                100 * fraction, duration(remaining).c_str(), state.strain, rate_, state.mach_max, state.area_drift,
                state.aggregates, state.aggregates == 1 ? "" : "s");
  if (!terminal_) {
    std::fprintf(stderr, "%s  step %ld  %s\n", state.stage.c_str(), state.step, numbers.c_str());
    return;
  }
  std::string line = state.stage.substr(0, 16) + " ";
  const auto width = static_cast<std::size_t>(terminal_width() - 1);
  if (width > line.size() + numbers.size() + 13)
    line += bar(fraction, static_cast<int>(std::min<std::size_t>(30, width - line.size() - numbers.size() - 3)));
  line = (line + numbers).substr(0, width);
  std::fprintf(stderr, "\r%s\x1b[K", line.c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::finish() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);  // what follows says how the run ended
  drawn_ = false;
}

}  // namespace rouleau::host
