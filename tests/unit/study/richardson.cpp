// Limits, orders and uncertainties against series whose limit is known.
#include "study/richardson.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>

using namespace rouleau::study;

namespace {

std::vector<GridValue> series(const std::vector<double>& spacings, const std::function<double(double)>& f) {
  std::vector<GridValue> grids;
  for (const double h : spacings) grids.push_back({h, f(h)});
  return grids;
}

/// Draws a smooth series f0 + C1 h^p + C2 h^(p + 1) on `count` grids whose spacings differ by factors of 1.2 to 2.
struct Draw {
  std::vector<GridValue> grids;
  double limit, finest_error;
};

Draw draw(std::mt19937_64& random, std::size_t count, double largest_second_term, double noise) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const int kind = std::uniform_int_distribution<int>(0, 2)(random);
  const double order = kind == 0 ? 1 : (kind == 1 ? 2 : uniform(0.8, 3));
  Draw result{{}, uniform(-1, 1), 0};
  const double first = uniform(0.01, 0.1);
  std::vector<double> spacings{1};
  while (spacings.size() < count) spacings.push_back(spacings.back() * uniform(1.2, 2));
  const double second = uniform(-largest_second_term, largest_second_term) * first / spacings.back();
  for (const double h : spacings) {
    const double error = first * std::pow(h, order) + second * std::pow(h, order + 1);
    if (h == 1) result.finest_error = std::abs(error);
    result.grids.push_back({h, result.limit + error + noise * first * std::normal_distribution<double>()(random)});
  }
  return result;
}

}  // namespace

TEST_CASE("limit and order of C h^p are exact, whatever the ratios of the grids", "[richardson]") {
  const double order = GENERATE(0.6, 1.0, 1.5, 2.0, 3.0);
  const double coefficient = GENERATE(0.3, -0.02);
  const auto spacings =
      GENERATE(std::vector<double>{0.1, 0.05, 0.025}, std::vector<double>{1.0 / 10, 1.0 / 20, 1.0 / 30},
               std::vector<double>{1.0 / 30, 1.0 / 10, 1.0 / 20, 1.0 / 15}, std::vector<double>{3, 1, 1.7, 2.1, 9});
  const Extrapolation e =
      extrapolate(series(spacings, [&](double h) { return 0.25 + coefficient * std::pow(h, order); }));
  CHECK(e.convergence == Convergence::asymptotic);
  CHECK(e.remark.empty());
  // The order is found by bisection or a search to 1e-9; round-off of the values is amplified a thousand times.
  CHECK(e.order == Approx(order).margin(1e-6));
  CHECK(e.limit == Approx(0.25).margin(1e-7));
  CHECK(std::abs(e.coefficient) * std::pow(0.5, e.order) ==
        Approx(std::abs(coefficient) * std::pow(0.5, order)).epsilon(1e-4));
  const double finest = *std::min_element(spacings.begin(), spacings.end());
  // The safety factor of the grid convergence index, and no less; less than that only where four grids agree.
  CHECK(e.uncertainty >=
        (spacings.size() > 3 ? 0.5 : 1.25) * std::abs(coefficient) * std::pow(finest, order) * (1 - 1e-4));
}

TEST_CASE("an order above two is told, but the uncertainty does not count on it", "[richardson]") {
  const Extrapolation e = extrapolate(series({1, 2, 4}, [](double h) { return 1 + 0.01 * h * h * h; }));
  CHECK(e.order == Approx(3));
  CHECK(e.limit == Approx(1));
  // Second order would put the limit (0.08 - 0.01)/3 below the finest value.
  CHECK(e.uncertainty >= 1.25 * 0.07 / 3 * (1 - 1e-9));
}

TEST_CASE("values that do not change have themselves as limit, and no order", "[richardson]") {
  const Extrapolation e = extrapolate({{1, 4, 0}, {2, 4, 0}, {3, 4, 0}});
  CHECK(e.convergence == Convergence::unchanging);
  CHECK(e.limit == 4);
  CHECK(e.uncertainty == 0);
  CHECK(std::isnan(e.order));
  CHECK(e.coefficient == 0);
}

TEST_CASE("differences below the values' own uncertainty tell nothing of an order", "[richardson]") {
  const Extrapolation e = extrapolate({{1, 10.25, 0.25}, {1.5, 10.5, 0.25}, {2, 10.25, 0.25}});
  CHECK(e.convergence == Convergence::unchanging);
  CHECK(e.uncertainty == Approx(0.75));  // three times what they differ by
  CHECK(extrapolate({{1, 10.25, 0.25}, {1.5, 10.25, 0.25}, {2, 10.25, 0.25}}).uncertainty == Approx(0.25));
}

TEST_CASE("what is outside the asymptotic range says so and is doubted", "[richardson]") {
  const auto remark_has = [](const Extrapolation& e, const std::string& words) {
    return e.remark.find(words) != std::string::npos;
  };
  SECTION("oscillating") {
    const Extrapolation e = extrapolate({{1, 1.00, 0}, {2, 1.02, 0}, {3, 0.98, 0}});
    CHECK(e.convergence == Convergence::oscillating);
    CHECK(remark_has(e, "go up and down"));
    CHECK(e.limit == 1.00);
    CHECK(e.uncertainty >= 3 * 0.02);
  }
  SECTION("an order below one half") {
    const Extrapolation e = extrapolate(series({1, 2, 4}, [](double h) { return 1 + 0.1 * std::pow(h, 0.3); }));
    CHECK(e.convergence == Convergence::slow);
    CHECK(remark_has(e, "0.3 is below 0.5"));
    CHECK(std::abs(e.limit - 1) <= e.uncertainty);
  }
  SECTION("an order above four") {
    const Extrapolation e = extrapolate(series({1, 2, 4}, [](double h) { return 1 + 1e-4 * std::pow(h, 6); }));
    CHECK(e.convergence == Convergence::fast);
    CHECK(remark_has(e, "above 4"));
    CHECK(std::abs(e.limit - 1) <= e.uncertainty);
  }
  SECTION("the finest two are equal by chance") {
    const Extrapolation e = extrapolate({{1, 1, 0}, {2, 1, 0}, {4, 1.5, 0}});
    CHECK(e.convergence == Convergence::fast);
    CHECK(e.uncertainty >= 0.5);
  }
  SECTION("differences that do not shrink") {
    const Extrapolation e = extrapolate({{1, 1, 0}, {2, 1.5, 0}, {4, 1.6, 0}});
    CHECK(e.convergence == Convergence::diverging);
    CHECK(std::isnan(e.limit));
    CHECK(std::isnan(e.uncertainty));
    CHECK(std::isnan(e.coefficient));
    CHECK(remark_has(e, "do not shrink"));
  }
}

TEST_CASE("grids without a value or given twice are left out, and two are too few", "[richardson]") {
  const double nan = std::nan("");
  const Extrapolation e = extrapolate({{4, 1.16, 0}, {0.5, nan, 0}, {1, 1.01, 0}, {2, 1.04, 0}, {2, 7, 0}});
  CHECK(e.order == Approx(2));
  CHECK(e.used == std::vector<std::size_t>{2, 3, 0});
  const Extrapolation few = extrapolate({{4, 1.16, 0}, {0.5, nan, 0}, {1, 1.01, 0}, {1, 1.01, 0}});
  CHECK(few.convergence == Convergence::unknown);
  CHECK(std::isnan(few.limit));
  CHECK(few.remark == "fewer than three grids have a value");
}

TEST_CASE("the order in which grids are given, and the unit of their spacing, change nothing", "[richardson]") {
  std::mt19937_64 random(7);
  for (int i = 0; i < 200; ++i) {
    Draw d = draw(random, 4, 0.8, 0.01);
    const Extrapolation before = extrapolate(d.grids);
    std::shuffle(d.grids.begin(), d.grids.end(), random);
    for (GridValue& grid : d.grids) grid.spacing *= 1e-7;
    const Extrapolation after = extrapolate(d.grids);
    REQUIRE(before.convergence == after.convergence);
    if (before.convergence == Convergence::diverging) continue;
    // Spacings times 1e-7 are rounded; extrapolation amplifies that, to less than this for grids so far apart.
    CHECK(after.limit == Approx(before.limit).epsilon(1e-6));
    CHECK(after.uncertainty == Approx(before.uncertainty).epsilon(1e-3));
  }
}

TEST_CASE("shifting and scaling the values shifts and scales the limit", "[richardson]") {
  std::mt19937_64 random(8);
  for (int i = 0; i < 200; ++i) {
    const Draw d = draw(random, 3, 0.8, 0);
    std::vector<GridValue> other = d.grids;
    for (GridValue& grid : other) grid.value = 3 - 2 * grid.value;
    const Extrapolation a = extrapolate(d.grids), b = extrapolate(other);
    REQUIRE(a.convergence == b.convergence);
    if (a.convergence == Convergence::diverging) continue;
    CHECK(b.limit == Approx(3 - 2 * a.limit).margin(1e-7));
    CHECK(b.uncertainty == Approx(2 * a.uncertainty).epsilon(1e-5).margin(1e-9));
  }
}

TEST_CASE("the limit lies within the uncertainty in at least 95 of 100 random series", "[richardson][optimised]") {
  std::mt19937_64 random(1);
  const std::size_t count = GENERATE(std::size_t{3}, std::size_t{4}, std::size_t{6});
  // The second term is up to this part of the first on the coarsest grid: at 0.8 the error hardly grows any more there.
  const double second_term = GENERATE(0.3, 0.8);
  // Relative to the error on a grid of spacing 1, the finest.
  const double noise = GENERATE(0.0, 0.003, 0.03);
  constexpr int draws = 4000;
  int within = 0, limits = 0;
  std::vector<double> sharpness;
  for (int i = 0; i < draws; ++i) {
    const Draw d = draw(random, count, second_term, noise);
    const Extrapolation e = extrapolate(d.grids);
    if (!std::isfinite(e.limit)) continue;
    ++limits;
    if (std::abs(e.limit - d.limit) <= e.uncertainty + 1e-12) ++within;
    sharpness.push_back(e.uncertainty / d.finest_error);
  }
  std::nth_element(sharpness.begin(), sharpness.begin() + limits / 2, sharpness.end());
  const double median = sharpness[static_cast<std::size_t>(limits) / 2];
  std::cout << "Richardson, " << count << " grids, second term " << second_term << ", noise " << noise
            << ": limit within "
            << "the uncertainty in " << 100.0 * within / limits << " %, uncertainty " << median
            << " times the error of the finest grid (median), no limit in " << 100.0 * (draws - limits) / draws
            << " %\n";
  CHECK(within >= 0.95 * limits);
  // With a second term of 0.8 the error may hardly shrink from the coarsest grid to the next: such series look
  // diverging, and are told to have no limit.
  CHECK(limits > (second_term < 0.5 ? 0.97 : 0.85) * draws);
  // An uncertainty that is always right because it is always huge is of no use.
  CHECK(median < 2);
}
