#include "stability/bisection.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

using namespace rouleau::stability;

namespace {

using Direction = StabilityEdge::Direction;

EdgeSearch search(const SearchRange& range, const std::function<bool(double)>& stable) {
  std::set<double> seen;
  return find_edges(range, [&](double value) -> std::optional<bool> {
    CHECK(seen.insert(value).second);  // no value twice
    CHECK(value >= rounded_value(range.from, range.whole));
    CHECK(value <= rounded_value(range.to, range.whole));
    return stable(value);
  });
}

}  // namespace

TEST_CASE("an edge is found within the precision, wherever it lies", "[bisection]") {
  const double edge = GENERATE(1.001e-6, 3e-5, 4.7e-3, 0.0999);
  const bool stable_below = GENERATE(true, false);
  const SearchRange range{1e-6, 0.1, Scale::logarithmic, 1.05};
  const EdgeSearch found = search(range, [&](double v) { return (v < edge) == stable_below; });
  REQUIRE(found.edges.size() == 1);
  const StabilityEdge& e = found.edges[0];
  CHECK(e.direction == (stable_below ? Direction::above : Direction::below));
  REQUIRE((e.stable_up_to && e.unstable_from));
  const double low = std::min(*e.stable_up_to, *e.unstable_from), high = std::max(*e.stable_up_to, *e.unstable_from);
  CHECK(low < edge);
  CHECK(high >= edge);
  CHECK(high <= low * 1.05);
  CHECK(found.out_of_order.empty());
  CHECK(found.complete);
  // Both ends, as many halvings of log(1e5)/log(1.05) as it takes, and one look into each of the two parts.
  CHECK(static_cast<double>(found.tried.size()) <= 2 + std::ceil(std::log2(std::log(1e5) / std::log(1.05))) + 2);
}

TEST_CASE("a linear search may cross zero", "[bisection]") {
  const EdgeSearch found = search({-1, 1, Scale::linear, 0.01}, [](double v) { return v < 0.25; });
  REQUIRE(found.edges.size() == 1);
  CHECK(*found.edges[0].stable_up_to < 0.25);
  CHECK(*found.edges[0].unstable_from >= 0.25);
  CHECK(*found.edges[0].unstable_from - *found.edges[0].stable_up_to <= 0.01);
}

TEST_CASE("a whole parameter is bracketed by neighbours", "[bisection]") {
  const EdgeSearch found = search({8, 1000, Scale::logarithmic, 1.0002, true}, [](double v) {
    CHECK(v == std::round(v));
    return v > 37;
  });
  REQUIRE(found.edges.size() == 1);
  CHECK(found.edges[0].direction == Direction::below);
  CHECK(*found.edges[0].stable_up_to == 38);
  CHECK(*found.edges[0].unstable_from == 37);
}

TEST_CASE("where nothing or everything is stable there is no edge", "[bisection]") {
  const bool all = GENERATE(true, false);
  const EdgeSearch found = search({1, 100, Scale::logarithmic, 1.1}, [all](double) { return all; });
  REQUIRE(found.edges.size() == 1);
  CHECK(found.edges[0].stable_up_to.has_value() == all);
  CHECK(found.edges[0].unstable_from.has_value() != all);
  CHECK(found.out_of_order.empty());
}

TEST_CASE("a range that is stable in its middle only has two edges", "[bisection]") {
  const EdgeSearch found = search({0.01, 100, Scale::logarithmic, 1.1}, [](double v) { return v > 0.2 && v < 20; });
  REQUIRE(found.edges.size() == 2);
  CHECK(found.edges[0].direction == Direction::below);
  CHECK(*found.edges[0].stable_up_to > 0.2);
  CHECK(*found.edges[0].unstable_from <= 0.2);
  CHECK(found.edges[1].direction == Direction::above);
  CHECK(*found.edges[1].stable_up_to < 20);
  CHECK(*found.edges[1].unstable_from >= 20);
  CHECK(found.out_of_order.empty());
}

TEST_CASE("a stable value beyond the edge and an unstable one before it are told", "[bisection]") {
  // Stable up to 10, and again from 300 to 900, where the look beyond the edge falls (the middle of 10 to 1e4: 316).
  const EdgeSearch beyond =
      search({1, 1e4, Scale::logarithmic, 1.01}, [](double v) { return v < 10 || (v > 300 && v < 900); });
  REQUIRE(beyond.edges.size() == 1);
  CHECK(*beyond.edges[0].stable_up_to < 10);
  REQUIRE(beyond.out_of_order.size() == 1);
  CHECK(beyond.out_of_order[0] == Approx(316).epsilon(0.02));
  // Both ends stable, the middle not.
  const EdgeSearch hole = search({1, 100, Scale::logarithmic, 1.1}, [](double v) { return v < 8 || v > 12; });
  REQUIRE(hole.edges.size() == 1);
  CHECK_FALSE(hole.edges[0].unstable_from);
  CHECK(hole.out_of_order == std::vector<double>{10});
}

TEST_CASE("a search that is interrupted says that it is not complete", "[bisection]") {
  int left = 4;
  const EdgeSearch found = find_edges({1, 1e4, Scale::logarithmic, 1.01}, [&](double v) -> std::optional<bool> {
    if (left-- == 0) return std::nullopt;
    return v < 10;
  });
  CHECK_FALSE(found.complete);
  CHECK(found.tried.size() == 4);
}
