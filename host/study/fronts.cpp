#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis.hpp"

namespace rouleau::study {
namespace {

/// What the second takes over what the first takes. A clock that cannot tell them apart says nothing about their price.
double time_factor(const StudyPoint& a, const StudyPoint& b) {
  const bool repeated = a.wall_range[0] < a.wall_range[1] || b.wall_range[0] < b.wall_range[1];
  if (repeated && a.wall_range[0] <= b.wall_range[1] && b.wall_range[0] <= a.wall_range[1]) return 1;
  return b.wall_s / a.wall_s;
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<double>& time, const std::vector<double>& error) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (std::isfinite(time[i]) && std::isfinite(error[i])) candidates.push_back(i);
  std::stable_sort(candidates.begin(), candidates.end(), [&](std::size_t a, std::size_t b) {
    return time[a] != time[b] ? time[a] < time[b] : error[a] < error[b];
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : candidates)
    if (front.empty() || error[i] < error[front.back()]) front.push_back(i);
  return front;
}

std::vector<Sensitivity> sensitivities_of(const StudyData& study, const std::vector<PointError>& errors) {
  std::vector<Sensitivity> sensitivities;
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    for (std::size_t i = 0; i < study.points.size(); ++i) {
      const auto label = static_cast<std::size_t>(study.points[i].setting[axis]);
      const std::size_t last = study.axes[axis].ordered ? std::min(label + 2, study.axes[axis].labels.size())
                                                        : study.axes[axis].labels.size();
      for (std::size_t other = label + 1; other < last; ++other) {
        std::vector<int> setting = study.points[i].setting;
        setting[axis] = static_cast<int>(other);
        const auto j = find_point(study, setting);
        if (!j) continue;
        Sensitivity sensitivity{axis,
                                i,
                                *j,
                                resolved_error(errors[i]) / resolved_error(errors[*j]),
                                time_factor(study.points[i], study.points[*j]),
                                0};
        if (sensitivity.error_factor < 1) {
          std::swap(sensitivity.from, sensitivity.to);
          sensitivity.error_factor = 1 / sensitivity.error_factor;
          sensitivity.time_factor = 1 / sensitivity.time_factor;
        }
        if (!std::isfinite(sensitivity.error_factor) || !std::isfinite(sensitivity.time_factor)) continue;
        const bool free = sensitivity.time_factor <= 1 && sensitivity.error_factor > 1;
        sensitivity.gain = free ? std::numeric_limits<double>::infinity()
                                : (sensitivity.error_factor == 1
                                       ? 0
                                       : std::log(sensitivity.error_factor) / std::log(sensitivity.time_factor));
        sensitivities.push_back(sensitivity);
      }
    }
  }
  std::stable_sort(sensitivities.begin(), sensitivities.end(), [](const Sensitivity& a, const Sensitivity& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.error_factor > b.error_factor;
  });
  return sensitivities;
}

}  // namespace rouleau::study
