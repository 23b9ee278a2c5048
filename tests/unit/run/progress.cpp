#include "run/progress.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

using namespace rouleau::run;

namespace {
const ProgressState state{123456, 0.42, "tumbling and separation", 12.345, 0.00123, 4.5e-4, 12};
bool shows(const std::string& line, const char* words) { return line.find(words) != std::string::npos; }
}  // namespace

TEST_CASE("a line of progress fits its terminal, and says what matters most longest") {
  for (std::size_t width = 1; width <= 300; ++width) {
    const std::string line = progress_line(state, 98765, 3.6e8, width);
    INFO(line);
    CHECK(line.size() <= width);
    if (width >= 50) CHECK((shows(line, "  42%") && shows(line, "  ETA 100000:00 h")));
    // No number is cut: each stands with its word, or not at all.
    if (width >= 50) CHECK((line.ends_with("strain 12.35") || line.ends_with("12 rouleaux") || line.ends_with(" h")));
    if (shows(line, "Mach")) CHECK(shows(line, "drift"));
    if (shows(line, "drift")) CHECK(shows(line, "steps/s"));
    if (shows(line, "steps/s")) CHECK(shows(line, "12 rouleaux"));
    if (shows(line, "12 rouleaux")) CHECK(shows(line, "["));
    if (shows(line, "[")) CHECK((shows(line, "strain 12.35") && shows(line, "]")));
  }
}

TEST_CASE("a terminal of 80 columns has a bar, and its numbers stay in their places") {
  ProgressState usual = state;
  usual.stage = "shear";
  CHECK(progress_line(usual, 12345, 65, 79) ==  // the last column stays free
        "shear [=========>             ]   42%  ETA  1:05 min  strain 12.35  12 rouleaux");
  const std::string early = progress_line({0, 0, "shear", 0, 0, 0, 0}, 0, 59, 79);
  CHECK(early == "shear [                       ]    0%  ETA      59 s  strain  0.00   0 rouleaux");
}

TEST_CASE("where nothing attracts there is no word of rouleaux, and in three dimensions a volume drifts") {
  ProgressState close = state;
  close.rouleaux = -1;
  close.drifting = "volume";
  const std::string line = progress_line(close, 12345, 65, 150);
  CHECK(!shows(line, "rouleau"));
  CHECK(shows(line, "volume drift"));
}

TEST_CASE("what is not known yet does not spoil a line of progress") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::string line = progress_line({0, none, "shear", 0, none, none, 1}, 0, none, 120);
  CHECK(line.starts_with("shear [          "));
  CHECK(
      shows(line, "    0%  ETA         ?  strain  0.00      0 steps/s  Mach     nan  area drift     nan   1 rouleau"));
}

TEST_CASE("the time that is left is that of the steps that are left, also when a stage ends early") {
  // 6 000 of 95 000 steps are taken in 60 s when a stage ends 60 000 steps before its time.
  const ProgressState early{6000, 0.69, "shear", 0, 0, 0, 1, 29000};
  CHECK(remaining_s(early, 6000, 60) == Approx(290));
  // Resumed at step 5 000.
  CHECK(remaining_s(early, 1000, 10) == Approx(290));
  CHECK(std::isnan(remaining_s(early, 0, 10)));
}
