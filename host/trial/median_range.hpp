// What repeated measurements of one thing come to.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace rouleau::trial {

/// NaN where nothing was measured.
struct MedianRange {
  double median = std::numeric_limits<double>::quiet_NaN(), least = median, most = median;
};

inline MedianRange median_range(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return {values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]), values.front(),
          values.back()};
}

}  // namespace rouleau::trial
