#include "statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "json/shown.hpp"

namespace rouleau::observe {

namespace {

constexpr std::size_t fewest_values = 20, fewest_batches = 10;
constexpr std::size_t groups = 20, largest_group = 5;  // of MSER
constexpr double left_out_more = 1.5;                  // what is left of a decay at MSER's minimum biases the mean
constexpr double most_correlation = 0.4;
constexpr double batch_growth = 1.25;
constexpr double fewest_parts = 15;
constexpr double most_rise = 3;

using Values = std::span<const double>;

double size_of(Values values) { return static_cast<double>(values.size()); }
double mean_of(Values values) { return std::accumulate(values.begin(), values.end(), 0.0) / size_of(values); }

/// Sum over pairs of values that are `lag` apart of their distances from the mean.
double products(Values values, double mean, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = lag; i < values.size(); ++i) sum += (values[i] - mean) * (values[i - lag] - mean);
  return sum;
}

/// Means of neighbouring values, so many each; what is too few for one is left out at the beginning.
Column means_of_groups(Values values, std::size_t length) {
  Column means;
  for (std::size_t i = values.size() % length; i < values.size(); i += length)
    means.push_back(mean_of(values.subspan(i, length)));
  return means;
}

/// Values at equal distances.
struct Even {
  Column values;
  double first = 0, distance = 0;
};

Even at_equal_distances(const Column& x, const Column& values) {
  Column place, value;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(values[i]) || (!place.empty() && !(x[i] > place.back()))) continue;
    place.push_back(x[i]);
    value.push_back(values[i]);
  }
  if (value.size() < fewest_values) return {value};
  Even even{{}, place.front(), (place.back() - place.front()) / static_cast<double>(place.size() - 1)};
  std::size_t k = 0;
  for (std::size_t number = 0; number < place.size(); ++number) {
    const double at = even.first + even.distance * static_cast<double>(number);
    while (k + 2 < place.size() && place[k + 1] < at) ++k;
    const double share = std::clamp((at - place[k]) / (place[k + 1] - place[k]), 0.0, 1.0);
    even.values.push_back(value[k] + share * (value[k + 1] - value[k]));
  }
  return even;
}

/// How many values are left out at the beginning.
std::size_t left_out(Values values) {
  const std::size_t length = std::clamp<std::size_t>(values.size() / groups, 1, largest_group);
  const Column means = means_of_groups(values, length);
  const double centre = mean_of(means);  // sums of squares around it lose no digits
  double total = 0, squares = 0, least = std::numeric_limits<double>::infinity();
  std::size_t start = 0;
  for (std::size_t i = means.size(); i-- > 0;) {
    total += means[i] - centre;
    squares += (means[i] - centre) * (means[i] - centre);
    const auto count = static_cast<double>(means.size() - i);
    const double spread = std::max(0.0, squares - total * total / count) / (count * count);
    if (means.size() - i < 5 || spread > least) continue;
    least = spread;
    start = i;
  }
  const auto more = static_cast<std::size_t>(std::ceil(left_out_more * static_cast<double>(start)));
  return more == 0 ? 0 : values.size() % length + more * length;
}

struct BatchError {
  double error;
  std::size_t batches;
};

/// Of the mean; nothing where too few batches are left that differ by chance.
std::optional<BatchError> error_from_batches(Values values) {
  for (std::size_t length = 1; values.size() / length >= fewest_batches;
       length = std::max(length + 1, static_cast<std::size_t>(static_cast<double>(length) * batch_growth))) {
    const Column means = means_of_groups(values, length);
    const double count = size_of(means), centre = mean_of(means), squares = products(means, centre, 0);
    if (!(squares > 0)) continue;
    const double correlation = (products(means, centre, 1) / squares + 1 / count) / (1 - 3 / count);
    if (correlation >= most_correlation) continue;
    const double rest = std::max(0.0, correlation);
    return BatchError{std::sqrt(squares / (count - 1) / count * (1 + rest) / (1 - rest)), means.size()};
  }
  return std::nullopt;
}

/// Whether a straight line through the values rises or falls by more than chance makes it.
bool rises(Values values, double mean) {
  const double count = size_of(values), middle = (count - 1) / 2;
  const auto along = [middle](std::size_t i) { return static_cast<double>(i) - middle; };
  double slope = 0;
  for (std::size_t i = 0; i < values.size(); ++i) slope += along(i) * (values[i] - mean);
  slope *= 12 / (count * (count * count - 1));
  Column rest;
  for (std::size_t i = 0; i < values.size(); ++i) rest.push_back(values[i] - mean - slope * along(i));
  const auto found = error_from_batches(rest);
  return found && std::abs(slope) * count > most_rise * std::sqrt(12.0) * found->error;
}

/// Student's t at 0.975, by bisection of the finite sums of Abramowitz and Stegun, 26.7.3 and 26.7.4. (Boost has it,
/// but works out constants whenever a program starts, and fails to under valgrind.)
double student_95(int freedom) {
  if (freedom > 1000) return 1.959964 + 2.3722 / freedom;  // the first term of Fisher's expansion: to 2e-6
  const auto inside = [freedom](double t) {                // probability between -t and t
    const double angle = std::atan2(t, std::sqrt(freedom)), cosine = std::cos(angle);
    const bool odd = freedom % 2 != 0;
    double term = odd ? cosine : 1, total = 0;
    for (int k = odd ? 3 : 2; k <= freedom; k += 2) {
      total += term;
      term *= cosine * cosine * (k - 1) / k;
    }
    return odd ? (angle + std::sin(angle) * total) * 2 / std::numbers::pi : std::sin(angle) * total;
  };
  double low = 1, high = 13;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (inside(middle) < 0.95 ? low : high) = middle;
  }
  return (low + high) / 2;
}

std::string too_few(double count, const char* what, double needed) {
  const auto text = [](double number) { return std::to_string(std::lround(number)); };
  return "too short: " + text(count) + " " + what + ", and " + text(needed) + " are needed";
}

}  // namespace

Statistics statistics(const Column& x, const Column& values) {
  const Even even = at_equal_distances(x, values);
  const double all = size_of(even.values);
  if (even.values.size() < fewest_values) return {too_few(all, "values", fewest_values)};
  const std::size_t start = left_out(even.values);
  if (2 * start > even.values.size()) return {"not steady: it still changes in its second half"};
  const Values kept = Values(even.values).subspan(start);
  const double count = size_of(kept), mean = mean_of(kept), variance = products(kept, mean, 0) / (count - 1);
  const double from = even.first + even.distance * static_cast<double>(start);
  if (variance <= 1e-28 * mean * mean) return {"steady", mean, 0, 0, from, count, even.distance};  // all are the same
  const auto found = error_from_batches(kept);
  if (!found) return {"too short: values remember longer than a tenth of the series"};
  Statistics result;
  result.parts = std::min(count, variance / (found->error * found->error));
  result.verdict = rises(kept, mean)             ? "not steady: it rises or falls all the time"
                   : result.parts < fewest_parts ? too_few(result.parts, "independent parts", fewest_parts)
                                                 : "steady";
  if (!result.steady()) return result;
  const double bar =
      student_95(static_cast<int>(std::min(static_cast<double>(found->batches), result.parts)) - 1) * found->error;
  return {"steady", mean, found->error, bar, from, result.parts, even.distance * count / result.parts};
}

void to_json(nlohmann::json& json, const Statistics& statistics) {
  json = {{"verdict", statistics.verdict},
          {"mean", json::number_or_null(statistics.mean)},
          {"standard_error", json::number_or_null(statistics.standard_error)},
          {"bar_95", json::number_or_null(statistics.bar_95)},
          {"from_s", json::number_or_null(statistics.from)},
          {"independent_parts", json::number_or_null(statistics.parts)},
          {"length_of_part_s", json::number_or_null(statistics.length)}};
}

}  // namespace rouleau::observe
