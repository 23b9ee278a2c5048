// What a run reports, read from its files.
#include "accuracy/quantities.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace rouleau::accuracy;

namespace {

constexpr double part = std::numbers::pi / 4;

}  // namespace

TEST_CASE("an angle that falls evenly passes each multiple where a line says, with no uncertainty") {
  const std::vector<double> x{0, 1, 2, 3}, angle{2 * part, 1.5 * part, part, 0.5 * part};
  const std::vector<Passage> found = passages(x, angle, part);
  REQUIRE(found.size() == 1);
  CHECK(found[0].multiple == 1);
  CHECK(found[0].at == Approx(2));
  CHECK(found[0].uncertainty == Approx(0).margin(1e-12));
}

TEST_CASE("several multiples between two rows are passed in their order, either way round") {
  const std::vector<double> x{0, 2};
  const std::vector<Passage> rising = passages(x, {-0.5 * part, 2.5 * part}, part);
  REQUIRE(rising.size() == 3);
  CHECK(rising[0].multiple == 0);
  CHECK(rising[2].multiple == 2);
  CHECK(rising[0].at < rising[1].at);
  const std::vector<Passage> falling = passages(x, {0.5 * part, -2.5 * part}, part);
  REQUIRE(falling.size() == 3);
  CHECK(falling[0].multiple == 0);
  CHECK(falling[2].multiple == -2);
  CHECK(falling[0].at < falling[1].at);
}

TEST_CASE("only the first passage of a multiple counts, and rows without an angle are gaps") {
  CHECK(passages({0, 1, 2, 3}, {0.5 * part, 1.5 * part, 0.5 * part, 1.5 * part}, part).size() == 1);
  CHECK(passages({0, 1, 2}, {0.5 * part, std::nan(""), 1.5 * part}, part).empty());
}

TEST_CASE("what a cell leaves at the start, up to rounding, it does not pass, but it does when it comes back") {
  for (const double rounding : {0.0, -1e-16, 1e-16}) {
    CHECK(passages({0, 1}, {rounding, 0.5 * part}, part).empty());
    const std::vector<Passage> found = passages({0, 1, 2}, {rounding, 0.5 * part, -0.5 * part}, part);
    REQUIRE(found.size() == 1);
    CHECK(found[0].at == Approx(1.5));
  }
  CHECK(passages({0, 1}, {-1e-6 * part, 0.5 * part}, part).size() == 1);
}

TEST_CASE("the uncertainty of a passage holds the true one of a curve that bends between rows") {
  // tan(angle) = 1/x turns as a thin cell in shear does.
  std::vector<double> x, angle;
  for (int i = 0; i <= 20; ++i) {
    x.push_back(-5 + 0.5 * i);
    angle.push_back(std::atan(-x.back()));
  }
  const std::vector<Passage> found = passages(x, angle, part);
  REQUIRE(found.size() == 3);
  for (const Passage& passage : found) {
    const double exact = -std::tan(passage.multiple * part);
    CHECK(std::abs(passage.at - exact) <= passage.uncertainty + 1e-12);
    CHECK(passage.uncertainty < 0.1);
  }
}
