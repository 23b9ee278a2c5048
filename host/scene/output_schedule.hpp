// When outputs are due within a stage.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "stage_scales.hpp"

namespace rouleau::scene {

/// Says at which steps of a stage an output is due: the steps nearest to multiples of an interval, and the first.
class OutputSchedule {
 public:
  OutputSchedule(const Cadence& cadence, const StageSetting& setting, bool always_some) {
    if (cadence.strain && setting.shear_rate != 0 && !setting.oscillation.any())
      intervals_.push_back(*cadence.strain / std::abs(setting.shear_rate));
    if (cadence.seconds) intervals_.push_back(setting.steps_of(*cadence.seconds));
    // A stage at rest has no strain to count by; forty rows show how it went.
    if (intervals_.empty() && !cadence.never() && always_some)
      intervals_.push_back(static_cast<double>(setting.max_steps) / 40);
    for (double& interval : intervals_) interval = std::max(interval, 1.0);
  }
  [[nodiscard]] bool due(long step) const {
    return std::any_of(intervals_.begin(), intervals_.end(), [step](double interval) {
      return step == std::lround(std::round(static_cast<double>(step) / interval) * interval);
    });
  }
  /// First step after this one at which an output is due; the largest number if there is none.
  [[nodiscard]] long next(long step) const {
    long first = std::numeric_limits<long>::max();
    for (const double interval : intervals_) {
      // An interval is at least one step, so that one of the next two multiples rounds to a later step.
      const double multiple = std::floor(static_cast<double>(step) / interval);
      for (int k = 0; k <= 2; ++k) {
        const long candidate = std::lround((multiple + k) * interval);
        if (candidate > step) {
          first = std::min(first, candidate);
          break;
        }
      }
    }
    return first;
  }

 private:
  std::vector<double> intervals_;  ///< steps
};

}  // namespace rouleau::scene
