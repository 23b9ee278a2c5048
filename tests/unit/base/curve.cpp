// Numbers read off curves that are known exactly.
#include "base/curve.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace rouleau;

namespace {
constexpr double turn = 2 * std::numbers::pi;
}

TEST_CASE("a straight line is interpolated and averaged exactly") {
  const Column x{0, 0.5, 0.5, 2, 3}, y{1, 2, 2, 5, 7};  // y = 1 + 2 x; a stage at rest repeats x
  CHECK(interpolated_at(x, y, 0.25) == Approx(1.5));
  CHECK(interpolated_at(x, y, 0.5) == Approx(2));
  CHECK(interpolated_at(x, y, 3) == Approx(7));
  CHECK(std::isnan(interpolated_at(x, y, 3.5)));
  CHECK(mean_from(x, y, 1) == Approx(5));  // (3 + 7) / 2
  CHECK(mean_from(x, y, 0) == Approx(4));
  CHECK(std::isnan(mean_from(x, y, -1)));
  CHECK(std::isnan(mean_from(x, y, 3)));
}

TEST_CASE("what has a gap is not averaged, but may be interpolated beside it") {
  const Column x{0, 1, 2, 3}, y{std::nan(""), 1, 2, 3};
  CHECK(std::isnan(interpolated_at(x, y, 0.5)));
  CHECK(interpolated_at(x, y, 1.5) == Approx(1.5));
  CHECK(std::isnan(mean_from(x, y, 0)));
  CHECK(mean_from(x, y, 1) == Approx(2));
}

TEST_CASE("the passage of an angle is the first one, whatever the way round") {
  const Column strain{0, 1, 2, 3, 4}, angle{1, 0, -2, 0, -4};
  CHECK(interpolated_at(angle, strain, -1) == Approx(1.5));
  CHECK(std::isnan(interpolated_at(angle, strain, -5)));
}

TEST_CASE("a turn takes what the angle's rate says, counted from a strain or back from the end") {
  const double sense = GENERATE(1.0, -1.0);
  Column strain, angle;
  for (int i = 0; i <= 100; ++i) {
    strain.push_back(0.3 * i);  // turns once in 8, and twice as fast from strain 15 on
    angle.push_back(sense * turn * (strain.back() <= 15 ? strain.back() / 8 : 15.0 / 8 + (strain.back() - 15) / 4));
  }
  CHECK(length_of_turns(strain, angle, 1, 1.1) == Approx(8));
  CHECK(length_of_turns(strain, angle, 0.5, 1.1) == Approx(4));
  CHECK(length_of_turns(strain, angle, 1, std::nullopt) == Approx(4));
  CHECK(length_of_turns(strain, angle, 4, std::nullopt) == Approx(15 + 2.0));  // 3.75 turns in 15, the rest at 8 each
  CHECK(std::isnan(length_of_turns(strain, angle, 6, std::nullopt)));
  CHECK(std::isnan(length_of_turns(strain, angle, 1, 27.5)));
}
