#include "progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace rouleau::run {

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

double within_one(double fraction) { return std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0; }

/// The numbers of a line in their order, each with what it is worth where room is short. Their widths do not change
/// from one line to the next.
struct Part {
  std::string text;
  int worth;
};
constexpr int worth_of_the_bar = 6;
std::vector<Part> parts(const ProgressState& state, double rate, double remaining_s) {
  std::vector<Part> all{{formatted("%3.0f%%", 100 * within_one(state.fraction)), 9},
                        {formatted("ETA %9s", duration(remaining_s).c_str()), 8},
                        {formatted("strain %5.2f", state.strain), 7},
                        {formatted("%5.0f steps/s", rate), 3},
                        {formatted("Mach %7.2g", state.mach_max), 1},
                        {formatted("%s drift %7.1e", state.drifting, state.area_drift), 2}};
  if (state.rouleaux >= 0)
    all.push_back({formatted(state.rouleaux == 1 ? "%2d rouleau " : "%2d rouleaux", state.rouleaux), 4});
  return all;
}
std::string joined(const std::vector<Part>& parts) {
  std::string text;
  for (const Part& part : parts) text += "  " + part.text;
  return text;
}

}  // namespace

std::string progress_line(const ProgressState& state, double rate, double remaining_s, std::size_t width) {
  constexpr std::size_t around = 3, shortest = 10, longest = 30;  // of the bar: a space and its brackets, and between
  const std::string stage = state.stage.substr(0, 16);
  std::vector<Part> shown = parts(state, rate, remaining_s);
  std::size_t bar_needs = around + shortest;
  const auto least = [&] {
    return std::min_element(shown.begin(), shown.end(), [](const Part& a, const Part& b) { return a.worth < b.worth; });
  };
  while (shown.size() > 1 && stage.size() + bar_needs + joined(shown).size() > width)
    if (bar_needs > 0 && least()->worth > worth_of_the_bar)
      bar_needs = 0;
    else
      shown.erase(least());
  const std::string numbers = joined(shown);
  if (bar_needs == 0) return (stage + numbers).substr(0, width);
  const std::size_t free = width - std::min(width, stage.size() + numbers.size() + around);
  return (stage + " " + bar(within_one(state.fraction), static_cast<int>(std::min(longest, free))) + numbers)
      .substr(0, width);
}

double remaining_s(const ProgressState& state, long steps_so_far, double seconds) {
  return steps_so_far > 0 ? seconds * state.steps_left / static_cast<double>(steps_so_far) : NAN;
}

Progress::Progress(bool quiet)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()), last_(start_) {}

void Progress::update(const ProgressState& state) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  if (!drawn_ && first_step_ < 0)  // a resumed run begins at a later step; its speed must not count the earlier ones
    first_step_ = last_step_ = state.step;
  const double since_last = Seconds(now - last_).count();
  if (since_last < (terminal_ ? 0.1 : 10.0)) return;

  const double remaining = remaining_s(state, state.step - first_step_, Seconds(now - start_).count());
  // The terminal shows the speed of the last second or so, a pipe that of the last line's interval.
  const double rate = static_cast<double>(state.step - last_step_) / since_last;
  rate_ = rate_ > 0 && terminal_ ? 0.9 * rate_ + 0.1 * rate : rate;
  last_ = now;
  last_step_ = state.step;

  if (!terminal_) {
    std::fprintf(stderr, "%s  step %ld%s\n", state.stage.c_str(), state.step,
                 joined(parts(state, rate_, remaining)).c_str());
    return;
  }
  const auto width = static_cast<std::size_t>(std::max(1, terminal_width() - 1));
  std::fprintf(stderr, "\r%s\x1b[K", progress_line(state, rate_, remaining, width).c_str());
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::finish() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);  // what follows says how the run ended
  drawn_ = false;
}

}  // namespace rouleau::run
