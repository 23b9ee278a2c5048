// Exact sums: against sums of integers, in any order and any parts.
#include "core/domain/exact_sum.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "unit/random.hpp"

using namespace rouleau;
using namespace rouleau::core;

namespace {

/// Numbers of very different size, of both signs.
std::vector<double> terms(std::mt19937& random, std::size_t count, double largest) {
  std::uniform_real_distribution<double> sign(-1, 1), exponent(-70, 0);
  std::vector<double> values(count);
  for (double& value : values) value = largest * sign(random) * std::exp2(exponent(random));
  return values;
}

double sum_of(const std::vector<double>& values) {
  ExactSum sum;
  sum.add(values.data(), values.size());
  return sum.value();
}

}  // namespace

TEST_CASE("a sum does not depend on the order of its terms, nor on the parts that it is formed of") {
  auto random = test::generator(301);
  const double largest = GENERATE(1e-9, 0.3, 1.0, 500.0, 1e6, 1e12);
  for (const std::size_t count : {1U, 7U, 8U, 100U, 5000U}) {
    std::vector<double> values = terms(random, count, largest);
    const double whole = sum_of(values);
    ExactSum one_by_one;
    for (const double value : values) one_by_one.add(value);
    CHECK(one_by_one.value() == whole);
    for (int trial = 0; trial < 5; ++trial) {
      std::shuffle(values.begin(), values.end(), random);
      const std::size_t cut = std::uniform_int_distribution<std::size_t>(0, count)(random);
      ExactSum left, right;
      left.add(values.data(), cut);
      right.add(values.data() + cut, count - cut);
      left.add(right);
      CHECK(left.value() == whole);
    }
  }
}

TEST_CASE("multiples of 2^-60 are added as the integers that they are") {
  auto random = test::generator(302);
  std::uniform_int_distribution<std::int64_t> integers(-(std::int64_t{1} << 50), std::int64_t{1} << 50);
  std::vector<double> values;
  std::int64_t exact = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t integer = integers(random);
    exact += integer;
    values.push_back(static_cast<double>(integer) * 0x1p-60);
  }
  CHECK(sum_of(values) == static_cast<double>(exact) * 0x1p-60);
}

TEST_CASE("sums of tiny terms are accurate") {
  CHECK(sum_of(std::vector<double>(4096, 1e-29)) == Approx(4.096e-26).epsilon(1e-6));
  CHECK(sum_of({1e-25, -3e-32, 0x1p-120}) == Approx(1e-25 - 3e-32).epsilon(1e-10));
}

TEST_CASE("large terms that cancel leave the small ones") {
  CHECK(sum_of({1e13, 1e-20, -1e13}) == Approx(1e-20).epsilon(1e-3));
  CHECK(sum_of({2047.5, 3e-18, -2047.5, 0x1p20, -0x1p20}) == Approx(3e-18).epsilon(1e-5));
}

TEST_CASE("a sum with a term that is no number, or beyond all bounds, is no number") {
  const double bad = GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e15);
  std::vector<double> values(100, 0.5);
  CHECK(sum_of(values) == 50);
  values[37] = bad;
  CHECK(std::isnan(sum_of(values)));
}
