// Borders of what is positive among samples.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "core/geometry/border.hpp"
#include "core/geometry/faceted.hpp"
#include "core/geometry/formulas.hpp"
#include "random.hpp"

using namespace rouleau::core;

namespace {

template <int D>
std::vector<double> samples_of(const Region<D>& region, int n) {
  std::vector<double> samples;
  int count = 1;
  for (int k = 0; k < D; ++k) count *= n;
  for (int i = 0; i < count; ++i) {
    Vec<D> place;
    for (int k = 0, rest = i; k < D; ++k, rest /= n) place[k] = rest % n;
    samples.push_back(region.distance(place).value);
  }
  return samples;
}

template <int D>
std::array<int, D> cube(int n) {
  std::array<int, D> size;
  size.fill(n);
  return size;
}

/// Largest error of the distance to a ball's sampled border, n samples across.
template <int D>
double largest_error(int n) {
  const Vec<D> center = Vec<D>::Constant(n / 2.0 - 0.3);
  const double radius = 0.35 * n;
  const auto ball = ball_region<D>(center, radius);
  const FacetedRegion<D> region(zero_border<D>(samples_of<D>(*ball, n), cube<D>(n)));
  std::mt19937 random = rouleau::test::generator(50);
  std::uniform_real_distribution<double> component(0, n - 1);
  double largest = 0;
  for (int i = 0; i < 300; ++i) {
    Vec<D> place;
    for (int k = 0; k < D; ++k) place[k] = component(random);
    largest = std::max(largest, std::abs(region.distance(place).value - ball->distance(place).value));
  }
  return largest / n;
}

}  // namespace

TEST_CASE("The border of a sampled ball is of second order", "[zero-border]") {
  CHECK(largest_error<2>(12) / largest_error<2>(48) > 12);
  CHECK(largest_error<3>(8) / largest_error<3>(32) > 12);
}

TEST_CASE("A border of random samples is closed and runs one way around", "[zero-border]") {
  std::mt19937 random = rouleau::test::generator(51);
  std::uniform_int_distribution<int> grey(0, 255);
  constexpr int n = 7;
  std::vector<double> flat(n * n, -1), solid(n * n * n, -1);
  for (int x = 1; x < n - 1; ++x) {
    for (int y = 1; y < n - 1; ++y) {
      flat[x + n * y] = grey(random) - 127.5;
      for (int z = 1; z < n - 1; ++z) solid[x + n * (y + n * z)] = grey(random) - 127.5;
    }
  }
  std::map<int, int> ends;
  for (const auto& [a, b] : zero_border<2>(flat, {n, n}).facets) ++ends[a], --ends[b];
  for (const auto& [corner, difference] : ends) CHECK(difference == 0);
  std::map<std::pair<int, int>, int> edges;
  for (const auto& facet : zero_border<3>(solid, {n, n, n}).facets) {
    for (int k = 0; k < 3; ++k) {
      const int a = facet[k], b = facet[(k + 1) % 3];
      a < b ? ++edges[{a, b}] : --edges[{b, a}];
    }
  }
  CHECK(edges.size() > 100);
  for (const auto& [edge, difference] : edges) CHECK(difference == 0);
}

TEST_CASE("What is positive among samples is inside of their border", "[zero-border]") {
  std::mt19937 random = rouleau::test::generator(52);
  std::uniform_int_distribution<int> grey(0, 255);
  constexpr int n = 9;
  std::vector<double> samples(n * n * n);
  for (double& sample : samples) sample = grey(random) - 127.5;
  const FacetedRegion<3> region(zero_border<3>(samples, {n, n, n}));
  for (int i = 0; i < n * n * n; ++i) {
    const Vec<3> place(i % n, i / n % n, i / n / n);
    if ((place.array() < 1).any() || (place.array() > n - 2).any()) continue;
    CHECK((region.distance(place).value > 0) == (samples[i] > 0));
  }
}
