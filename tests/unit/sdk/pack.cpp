// Packs compute like the numbers they hold, and exp is accurate.
#include <rouleau/pack.hpp>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "instruction_sets.hpp"

namespace {

using rouleau::Pack;

template <class S>
std::vector<typename S::Number> values_of(const S& pack) {
  std::vector<typename S::Number> values(S::size);
  pack.store(values.data());
  return values;
}

template <class T, int N>
void check_arithmetic(unsigned seed) {
  using S = Pack<T, N>;
  CAPTURE(seed, N, sizeof(T));
  std::mt19937 random(seed);
  std::uniform_real_distribution<T> uniform(-10, 10);
  T a[N], b[N];
  for (int i = 0; i < N; ++i) {
    a[i] = uniform(random);
    b[i] = i % 3 == 0 ? a[i] : uniform(random);
  }
  const S x = S::load(a), y = S::load(b);
  const auto sum = values_of(x + y), difference = values_of(x - y), product = values_of(x * y),
             ratio = values_of(x / y);
  const auto smaller = values_of(min(x, y)), larger = values_of(max(x, y)), size = values_of(abs(x)),
             opposite = values_of(-x), root = values_of(sqrt(abs(x))), mixed = values_of(2.0 * x + 1);
  const auto below = values_of(select(x < y, S(1), S(0))), not_above = values_of(select(x <= y, S(1), S(0))),
             above = values_of(select(!(x <= y), S(1), S(0))),
             same = values_of(select((x <= y) & (x >= y), S(1), S(0))),
             other = values_of(select((x < y) | (x > y), S(1), S(0)));
  for (std::size_t i = 0; i < N; ++i) {
    CHECK(sum[i] == a[i] + b[i]);
    CHECK(difference[i] == a[i] - b[i]);
    CHECK(product[i] == a[i] * b[i]);
    CHECK(ratio[i] == a[i] / b[i]);
    CHECK(smaller[i] == std::min(a[i], b[i]));
    CHECK(larger[i] == std::max(a[i], b[i]));
    CHECK(size[i] == std::abs(a[i]));
    CHECK(opposite[i] == -a[i]);
    CHECK(root[i] == std::sqrt(std::abs(a[i])));
    CHECK(mixed[i] == 2 * a[i] + 1);
    CHECK(below[i] == (a[i] < b[i]));
    CHECK(not_above[i] == (a[i] <= b[i]));
    CHECK(above[i] == (a[i] > b[i]));
    CHECK(same[i] == (a[i] == b[i]));
    CHECK(other[i] == (a[i] != b[i]));
  }
}

/// Roots of a whole array and their inverses by one instruction set.
template <class T>
struct RootLoop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const T* from, T* root, T* inverse, std::uint32_t count) {
    using S = Pack<T, register_bytes / static_cast<int>(sizeof(T))>;
    for (std::uint32_t i = 0; i < count; i += S::size) {
      const auto result = sqrt_and_inverse(S::load(from + i));
      result.root.store(root + i);
      result.inverse.store(inverse + i);
    }
  }
};

/// Whether an array's numbers are taken one by one into whole packs.
struct BroadcastLoop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const double* from, int* different, std::uint32_t count) {
    using S = Pack<double, register_bytes / 8>;
    for (std::uint32_t i = 0; i < count; ++i) {
      const S all = S::broadcast(from + i);
      for (int k = 0; k < S::size; ++k) *different += all.vector[k] != from[i] ? 1 : 0;
    }
  }
};

/// exp of a whole array by one instruction set.
struct ExpLoop {
  template <int register_bytes>
  ROULEAU_ALWAYS_INLINE static void run(const double* from, double* to, std::uint32_t count) {
    using S = Pack<double, register_bytes / 8>;
    for (std::uint32_t i = 0; i < count; i += S::size) exp(S::load(from + i)).store(to + i);
  }
};

/// Distance from the exact value in units of the last place of the number nearest to it.
template <class T>
double ulps(T value, long double exact) {
  const T nearest = static_cast<T>(exact);
  const T ulp = std::nextafter(nearest, std::numeric_limits<T>::infinity()) - nearest;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact)) / ulp;
}

std::vector<double> exp_of(std::vector<double> arguments, const std::string& set) {
  const std::size_t count = arguments.size();
  arguments.resize((count + 7) / 8 * 8, 0.0);
  std::vector<double> results(arguments.size());
  rouleau::test::pick_for<ExpLoop, const double*, double*, std::uint32_t>(set)(
      arguments.data(), results.data(), static_cast<std::uint32_t>(arguments.size()));
  results.resize(count);
  return results;
}

template <class T>
void check_roots() {
  const unsigned seed = std::random_device{}();
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<long double> exponent(std::numeric_limits<T>::min_exponent10 + 1,
                                                       std::numeric_limits<T>::max_exponent10 - 1);
  std::vector<T> arguments(1 << 16);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    arguments[i] = static_cast<T>(i % 2 == 0 ? std::pow(10.0L, exponent(random)) : 1 + i * 1e-4L);
  }
  for (const auto& set : rouleau::test::instruction_sets()) {
    std::vector<T> root(arguments.size()), inverse(arguments.size());
    rouleau::test::pick_for<RootLoop<T>, const T*, T*, T*, std::uint32_t>(set)(
        arguments.data(), root.data(), inverse.data(), static_cast<std::uint32_t>(arguments.size()));
    double worst = 0;
    T worst_argument = 0;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const long double exact = std::sqrt(static_cast<long double>(arguments[i]));
      const double error = std::max(ulps(root[i], exact), ulps(inverse[i], 1 / exact));
      if (error > worst) worst = error, worst_argument = arguments[i];
    }
    CAPTURE(seed, sizeof(T), set, worst_argument);
    CHECK(worst <= 2);
  }
}

}  // namespace

TEST_CASE("sqrt and 1 / sqrt are within two units in the last place for each instruction set") {
  check_roots<double>();
  check_roots<float>();
}

TEST_CASE("a number at an address fills a pack for each instruction set") {
  const std::vector<double> numbers{0.0, 1.5, -2.0, std::numeric_limits<double>::infinity(), 1e-310};
  for (const auto& set : rouleau::test::instruction_sets()) {
    CAPTURE(set);
    int different = 0;
    rouleau::test::pick_for<BroadcastLoop, const double*, int*, std::uint32_t>(set)(
        numbers.data(), &different, static_cast<std::uint32_t>(numbers.size()));
    CHECK(different == 0);
  }
}

TEST_CASE("packs of every width compute bit for bit what plain numbers do") {
  const unsigned seed = std::random_device{}();
  check_arithmetic<double, 2>(seed);
  check_arithmetic<double, 4>(seed);
  check_arithmetic<double, 8>(seed);
  check_arithmetic<float, 4>(seed);
  check_arithmetic<float, 8>(seed);
  check_arithmetic<float, 16>(seed);
}

TEST_CASE("a pack made of one number holds it everywhere, infinity too; a zero loses its sign") {
  for (const double value : {0.0, -0.0, 1.5, -2.0, std::numeric_limits<double>::infinity(), 1e-310}) {
    for (const double lane : values_of(Pack<double, 4>(value))) {
      CHECK(lane == value);
      CHECK(std::signbit(lane) == (value < 0));
    }
  }
}

TEST_CASE("exp is within two units in the last place for each instruction set") {
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  std::vector<double> arguments;
  for (const double range : {708.0, 50.0, 1.0, 1e-3, 1e-12}) {
    std::uniform_real_distribution<double> uniform(-range, range);
    for (int i = 0; i < 20000; ++i) arguments.push_back(uniform(random));
  }
  // Halfway between integers times ln 2, where the reduced argument is largest and its rounding changes direction.
  for (int n = -1000; n < 1000; ++n) arguments.push_back((n + 0.5) * 0.6931471805599453);
  for (const auto& set : rouleau::test::instruction_sets()) {
    const auto results = exp_of(arguments, set);
    double worst = 0, worst_argument = 0;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const double error = ulps(results[i], std::exp(static_cast<long double>(arguments[i])));
      if (error > worst) worst = error, worst_argument = arguments[i];
    }
    CAPTURE(set, worst_argument);
    CHECK(worst <= 2);
  }
}

TEST_CASE("exp keeps its promises at the edges of its range") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& set : rouleau::test::instruction_sets()) {
    CAPTURE(set);
    const auto r = exp_of({0, -0.0, 709, 709.0001, 1e6, infinity, -708, -708.0001, -1e6, -infinity, nan, 1e-310}, set);
    CHECK(r[0] == 1);
    CHECK(r[1] == 1);
    CHECK(ulps(r[2], std::exp(709.0L)) <= 2);
    CHECK(r[3] == infinity);
    CHECK(r[4] == infinity);
    CHECK(r[5] == infinity);
    CHECK(ulps(r[6], std::exp(-708.0L)) <= 2);
    CHECK(r[7] == 0);
    CHECK(r[8] == 0);
    CHECK(r[9] == 0);
    CHECK(std::isnan(r[10]));
    CHECK(r[11] == 1);
  }
}

TEST_CASE("the environment can lower the instruction set and an unknown name changes nothing") {
  using rouleau::instruction_set;
  unsetenv("ROULEAU_INSTRUCTION_SET");
  const auto widest = instruction_set();
  for (const char* name : {"baseline", "avx2", "avx512", "neon", ""}) {
    setenv("ROULEAU_INSTRUCTION_SET", name, 1);
    CHECK(instruction_set() <= widest);
  }
  setenv("ROULEAU_INSTRUCTION_SET", "baseline", 1);
  CHECK(instruction_set() == rouleau::InstructionSet::baseline);
  setenv("ROULEAU_INSTRUCTION_SET", "unknown", 1);
  CHECK(instruction_set() == widest);
  unsetenv("ROULEAU_INSTRUCTION_SET");
}
