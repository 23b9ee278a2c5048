// log, log1p, expm1, pow, sin, cos, tanh and erf of packs: accurate, the same bits for each instruction set, right at
// their edges.
#include <rouleau/functions.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <iostream>
#include <limits>
#include <random>
#include <vector>

#include "instruction_sets.hpp"

namespace {

using rouleau::Pack;

enum class Function { log, log1p, expm1, pow, sin, cos, tanh, erf };

template <class S, Function function>
ROULEAU_ALWAYS_INLINE S value_of(const S& x, const S& y) {
  if constexpr (function == Function::log) return log(x);
  if constexpr (function == Function::log1p) return log1p(x);
  if constexpr (function == Function::expm1) return expm1(x);
  if constexpr (function == Function::pow) return pow(x, y);
  if constexpr (function == Function::sin) return sin(x);
  if constexpr (function == Function::cos) return cos(x);
  if constexpr (function == Function::tanh) return tanh(x);
  if constexpr (function == Function::erf) return erf(x);
}

/// A function of whole arrays by one instruction set.
template <class T, Function function>
struct Loop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const T* x, const T* y, T* to, std::uint32_t count) {
    using S = Pack<T, register_bytes / static_cast<int>(sizeof(T))>;
    for (std::uint32_t i = 0; i < count; i += S::size) {
      value_of<S, function>(S::load(x + i), S::load(y + i)).store(to + i);
    }
  }
};

template <class T>
struct Arguments {
  std::vector<T> x, y;
  void add(double a, double b = 1) {
    x.push_back(static_cast<T>(a));
    y.push_back(static_cast<T>(b));
  }
};

template <class T, Function function>
std::vector<T> values(Arguments<T> at, const std::string& set) {
  const std::size_t count = at.x.size();
  while (at.x.size() % 16 != 0) at.add(1);
  std::vector<T> results(at.x.size());
  rouleau::test::pick_for<Loop<T, function>, const T*, const T*, T*, std::uint32_t>(set)(
      at.x.data(), at.y.data(), results.data(), static_cast<std::uint32_t>(at.x.size()));
  results.resize(count);
  return results;
}

long double exact(Function function, long double x, long double y) {
  switch (function) {
    case Function::log:
      return std::log(x);
    case Function::log1p:
      return std::log1p(x);
    case Function::expm1:
      return std::expm1(x);
    case Function::pow:
      return std::pow(x, y);
    case Function::sin:
      return std::sin(x);
    case Function::cos:
      return std::cos(x);
    case Function::tanh:
      return std::tanh(x);
    case Function::erf:
      return std::erf(x);
  }
  return 0;
}

/// Distance from the exact value in units of the last place; 0 where both are infinite or both NaN.
template <class T>
double ulps(T value, long double exact) {
  constexpr long double largest = std::numeric_limits<T>::max();
  if (std::isnan(exact) || std::isnan(value)) return std::isnan(exact) == std::isnan(value) ? 0 : 1e300;
  if (std::abs(exact) > largest && std::isinf(value)) return std::signbit(value) == std::signbit(exact) ? 0 : 1e300;
  if (std::isinf(value)) return 1e300;
  const long double wanted = std::min(std::abs(exact), largest);
  const T size = static_cast<T>(wanted), below = std::nextafter(size, T(0));
  // At a power of two the numbers above it are twice as far apart as those below.
  const bool above = wanted > size && size < static_cast<T>(largest);
  const T apart = above ? std::nextafter(size, static_cast<T>(largest)) - size : size - below,
          ulp = apart > 0 ? apart : std::numeric_limits<T>::denorm_min();
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / ulp);
}

/// Random numbers of either sign with magnitudes from 10^low to 10^high.
template <class T>
void add_wide(Arguments<T>& to, std::mt19937_64& random, double low, double high, int count, bool positive = false) {
  std::uniform_real_distribution<double> exponent(low, high), other(-1, 1);
  for (int i = 0; i < count; ++i) {
    const double size = std::pow(10, exponent(random));
    to.add(positive || i % 2 == 0 ? size : -size, other(random));
  }
}

template <class T>
void add_range(Arguments<T>& to, std::mt19937_64& random, double low, double high, int count) {
  std::uniform_real_distribution<double> uniform(low, high);
  for (int i = 0; i < count; ++i) to.add(uniform(random));
}

/// Every function at its arguments, by each instruction set: largest error, and bits against the first set.
template <class T, Function function>
void check(const char* name, const Arguments<T>& at, double limit) {
  std::vector<T> first;
  for (const auto& set : rouleau::test::instruction_sets()) {
    const std::vector<T> results = values<T, function>(at, set);
    double worst = 0;
    std::size_t where = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
      const double error = ulps(results[i], exact(function, at.x[i], at.y[i]));
      if (error > worst) worst = error, where = i;
    }
    CAPTURE(name, set, sizeof(T), worst, at.x[where], at.y[where], results[where]);
    CHECK(worst <= limit);
    if (first.empty()) {
      first = results;
      std::cout << name << (sizeof(T) == 8 ? " f64 " : " f32 ") << worst << " ulp of " << results.size() << " at "
                << at.x[where] << ", " << at.y[where] << '\n';
    }
    // NaN's sign is the processor's choice.
    std::size_t different = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
      const bool same = std::memcmp(&first[i], &results[i], sizeof(T)) == 0;
      if (!same && !(std::isnan(first[i]) && std::isnan(results[i]))) ++different;
    }
    CHECK(different == 0);
  }
}

template <class T>
void check_all(bool in_float) {
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  const double low = std::numeric_limits<T>::min_exponent10 - (in_float ? 6 : 14),
               high = std::numeric_limits<T>::max_exponent10;
  constexpr int many = 100000;
  const auto limit = [&](double in_double) { return in_float ? 0.51 : in_double; };

  Arguments<T> logarithm;
  add_wide(logarithm, random, low, high, many, true);
  add_wide(logarithm, random, -1, 1, many, true);
  for (const double width : {0.5, 1e-2, 1e-5, 1e-9}) add_range(logarithm, random, 1 - width, 1 + width, many);
  check<T, Function::log>("log", logarithm, limit(1));

  add_range(logarithm, random, -0.999, 0.999, many);
  check<T, Function::log1p>("log1p", logarithm, limit(2));

  Arguments<T> power;
  std::uniform_real_distribution<double> result(-745, 709), base(-1, 1), small(-6, 6);
  for (int i = 0; i < 4 * many; ++i) {  // the result is anywhere in the range, also where the base is near 1
    const double range = i % 4 == 0 ? 700 : i % 4 == 1 ? 1 : i % 4 == 2 ? 0.05 : 1e-4;
    const T x = static_cast<T>(std::exp(range * base(random)));
    power.add(x, result(random) * (in_float ? 0.12 : 1) / std::log(static_cast<double>(x)));
  }
  for (int i = 0; i < many; ++i) power.add(std::pow(10, small(random)), small(random));
  for (int i = 0; i < many; ++i)
    power.add((i % 2 == 0 ? -1 : 1) * std::pow(10, small(random)), std::round(5 * small(random)));
  check<T, Function::pow>("pow", power, limit(1));

  Arguments<T> angle;
  add_wide(angle, random, low, 6, many);
  for (const double width : {0.8, 3.2, 100.0, 1e4, 1e6}) add_range(angle, random, -width, width, many);
  // Nearest to multiples of pi/2, where most is lost.
  for (int n = -636619; n <= 636619; n += 7) angle.add(n * 1.57079632679489661923);
  check<T, Function::sin>("sin", angle, limit(1));
  check<T, Function::cos>("cos", angle, limit(1));

  Arguments<T> number;
  add_wide(number, random, low, high, many);
  add_wide(number, random, -3, 1, many);
  for (const double width : {0.7, 1.3, 3.0, 7.0, 25.0}) add_range(number, random, -width, width, many);
  check<T, Function::expm1>("expm1", number, limit(2));
  check<T, Function::tanh>("tanh", number, limit(2));
  check<T, Function::erf>("erf", number, limit(1));
}

}  // namespace

TEST_CASE(
    "log, log1p, expm1, pow, sin, cos, tanh and erf are accurate and have the same bits for each instruction set") {
  check_all<double>(false);
  check_all<float>(true);
}

TEST_CASE("functions of packs do at the edges what those of plain numbers do, and NaN stays NaN") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN(), tiny = 4.9e-324,
               largest = std::numeric_limits<double>::max();
  const std::vector<double> edges = {0.0,
                                     -0.0,
                                     tiny,
                                     -tiny,
                                     2.2250738585072014e-308,
                                     1e-310,
                                     0.5,
                                     -0.5,
                                     1,
                                     -1,
                                     2,
                                     -2,
                                     3,
                                     -3,
                                     0.1,
                                     1e6,
                                     -1e6,
                                     4503599627370497.0,
                                     -4503599627370497.0,
                                     9007199254740991.0,
                                     9007199254740992.0,
                                     1e300,
                                     -1e300,
                                     largest,
                                     -largest,
                                     infinity,
                                     -infinity,
                                     nan,
                                     std::nextafter(1.0, 0.0),
                                     std::nextafter(1.0, 2.0)};
  Arguments<double> pairs, alone;
  for (const double x : edges) {
    for (const double y : edges) pairs.add(x, y);
    alone.add(x);
  }
  const auto agree = [&](const std::vector<double>& results, const Arguments<double>& at,
                         double (*reference)(double, double), const std::string& set) {
    for (std::size_t i = 0; i < results.size(); ++i) {
      const double expected = reference(at.x[i], at.y[i]);
      CAPTURE(set, at.x[i], at.y[i], results[i], expected);
      if (std::isnan(expected)) {
        CHECK(std::isnan(results[i]));
      } else {
        CHECK(ulps(results[i], expected) <= 2);
        CHECK(std::signbit(results[i]) == std::signbit(expected));
      }
    }
  };
  for (const auto& set : rouleau::test::instruction_sets()) {
    agree(
        values<double, Function::log>(alone, set), alone, [](double x, double) { return std::log(x); }, set);
    agree(
        values<double, Function::log1p>(alone, set), alone, [](double x, double) { return std::log1p(x); }, set);
    agree(
        values<double, Function::expm1>(alone, set), alone, [](double x, double) { return std::expm1(x); }, set);
    agree(
        values<double, Function::tanh>(alone, set), alone, [](double x, double) { return std::tanh(x); }, set);
    agree(
        values<double, Function::erf>(alone, set), alone, [](double x, double) { return std::erf(x); }, set);
    const auto angle = [](double x) { return std::abs(x) <= 1e6 ? x : std::numeric_limits<double>::quiet_NaN(); };
    static const auto in_range = angle;
    agree(
        values<double, Function::sin>(alone, set), alone, [](double x, double) { return std::sin(in_range(x)); }, set);
    agree(
        values<double, Function::cos>(alone, set), alone, [](double x, double) { return std::cos(in_range(x)); }, set);
    agree(
        values<double, Function::pow>(pairs, set), pairs,
        [](double x, double y) { return std::isnan(x) || std::isnan(y) ? x + y : std::pow(x, y); }, set);
  }
}

TEST_CASE("a function's value does not depend on its place in the pack") {
  Arguments<double> at;
  for (int i = 0; i < 64; ++i) at.add(0.01 + 0.17 * i, 0.3 * i - 4);
  for (const auto& set : rouleau::test::instruction_sets()) {
    const auto whole = values<double, Function::pow>(at, set);
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      Arguments<double> shifted;
      for (std::size_t k = 0; k < 16; ++k) shifted.add(at.x[(i + k) % 64], at.y[(i + k) % 64]);
      const auto part = values<double, Function::pow>(shifted, set);
      for (std::size_t k = 0; k < 16; ++k) CHECK(part[k] == whole[(i + k) % 64]);
    }
  }
}
