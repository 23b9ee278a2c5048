#include "observe/statistics.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

using rouleau::Column;
using rouleau::observe::Statistics;

namespace {

/// Values at times 0, 0.1, 0.2, ...
Statistics of(int count, const std::function<double(int)>& value) {
  Column times, values;
  for (int k = 0; k < count; ++k) {
    times.push_back(0.1 * k);
    values.push_back(value(k));
  }
  return rouleau::observe::statistics(times, values);
}

/// An autoregressive process of mean 0 and variance 1, in which neighbours have this correlation.
struct Autoregressive {
  double correlation;
  std::mt19937_64 random;
  std::normal_distribution<double> normal = {};
  double value = normal(random);
  double next() { return value = correlation * value + std::sqrt(1 - correlation * correlation) * normal(random); }
};

}  // namespace

TEST_CASE("bars of 95 % hold the true mean of correlated series in 95 % of cases, and errors are the exact ones") {
  for (const double correlation : {0.0, 0.5, 0.9}) {
    int steady = 0, inside = 0;
    double error = 0;
    constexpr int count = 3000;
    for (unsigned seed = 1; seed <= 200; ++seed) {
      Autoregressive process{correlation, std::mt19937_64(seed)};
      const Statistics found = of(count, [&](int) { return process.next(); });
      if (!found.steady()) continue;
      ++steady;
      error += found.standard_error;
      if (std::abs(found.mean) <= found.bar_95) ++inside;
    }
    CAPTURE(correlation, steady, inside);
    CHECK(steady >= 190);
    // Binomial of 200 with 0.95: three standard deviations are 4.6 %.
    CHECK(std::abs(static_cast<double>(inside) / steady - 0.95) < 0.046);
    const double exact = std::sqrt((1 + correlation) / (1 - correlation) / count);
    CHECK(error / steady == Approx(exact).epsilon(0.15));  // some values are left out at the beginning
  }
}

TEST_CASE("a series that decays is steady from where the decay is over, and not before") {
  Autoregressive process{0.5, std::mt19937_64(3)};
  const Statistics found = of(2000, [&](int k) { return 5 + 40 * std::exp(-k / 50.0) + process.next(); });
  CHECK(found.verdict == "steady");
  CHECK(found.from > 0.1 * 100);  // the decay is 5.4 there
  CHECK(found.from < 0.1 * 1000);
  CHECK(std::abs(found.mean - 5) < 2 * found.bar_95);
  CHECK(found.length == Approx(0.3).epsilon(0.4));  // (1 + r) / (1 - r) values
}

TEST_CASE("without a steady part there is no mean, and the verdict says why") {
  Autoregressive process{0.5, std::mt19937_64(7)};
  const auto refused = [](const Statistics& found, const char* why) {
    CAPTURE(found.verdict);
    CHECK(found.verdict.find(why) != std::string::npos);
    CHECK(std::isnan(found.mean));
    CHECK(std::isnan(found.bar_95));
  };
  refused(of(19, [&](int) { return process.next(); }), "too short: 19 values, and 20 are needed");
  refused(of(500, [&](int k) { return 0.05 * k + process.next(); }), "not steady");
  refused(of(300, [](int k) { return std::sin(2 * 3.14159 * k / 300.0); }), "");
  refused(rouleau::observe::statistics({}, {}), "too short: 0 values");
  refused(of(100, [](int) { return std::nan(""); }), "too short: 0 values");
}

TEST_CASE("values that are all the same have that mean, and gaps and times that stand twice are left out") {
  const Statistics same = of(50, [](int k) { return k % 3 == 0 ? std::nan("") : 2.5; });
  CHECK(same.steady());
  CHECK(same.mean == 2.5);
  CHECK(same.bar_95 == 0);
  Column times, values;
  for (int k = 0; k < 40; ++k) {
    times.push_back(k / 2);
    values.push_back(k % 2 == 0 ? 1 : 100);  // the second at a time does not count
  }
  CHECK(rouleau::observe::statistics(times, values).mean == 1);
}
