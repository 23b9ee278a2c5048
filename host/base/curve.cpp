#include "curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rouleau {

namespace {

constexpr double not_a_value = std::numeric_limits<double>::quiet_NaN();

double between(double a, double b, double share) { return a + share * (b - a); }

}  // namespace

double interpolated_at(const Column& x, const Column& y, double at) {
  for (std::size_t i = 1; i < x.size(); ++i)
    if ((x[i - 1] - at) * (x[i] - at) <= 0 && x[i] != x[i - 1])
      return between(y[i - 1], y[i], (at - x[i - 1]) / (x[i] - x[i - 1]));
  return not_a_value;
}

double mean_from(const Column& x, const Column& y, double from) {
  double integral = 0, length = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] <= from || x[i] == x[i - 1]) continue;
    const bool cut = x[i - 1] < from;
    const double start = cut ? from : x[i - 1];
    const double first = cut ? between(y[i - 1], y[i], (from - x[i - 1]) / (x[i] - x[i - 1])) : y[i - 1];
    integral += (x[i] - start) * (first + y[i]) / 2;
    length += x[i] - start;
  }
  return length > 0 && x.front() <= from ? integral / length : not_a_value;
}

double length_of_turns(const Column& x, const Column& angle, double turns, std::optional<double> from) {
  if (x.size() < 2) return not_a_value;
  const double wanted = 2 * std::numbers::pi * turns;
  if (!from) {
    for (std::size_t i = x.size() - 1; i-- > 0;) {
      const double behind = std::abs(angle.back() - angle[i]), after = std::abs(angle.back() - angle[i + 1]);
      if (std::isnan(behind)) return not_a_value;
      if (behind >= wanted) return x.back() - between(x[i], x[i + 1], (behind - wanted) / (behind - after));
    }
    return not_a_value;
  }
  const double start = interpolated_at(x, angle, *from);
  for (std::size_t i = 1; i < x.size() && std::isfinite(start); ++i) {
    if (x[i] <= *from) continue;
    const double turned = std::abs(angle[i] - start), before = x[i - 1] <= *from ? 0.0 : std::abs(angle[i - 1] - start);
    const double left = std::max(x[i - 1], *from);
    if (turned >= wanted) return between(left, x[i], (wanted - before) / (turned - before)) - *from;
    if (std::isnan(turned)) break;
  }
  return not_a_value;
}

}  // namespace rouleau
