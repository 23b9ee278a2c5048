// The search for the cheapest setting that meets a target error: which point to run next, and what has been shown.
//
// A point meets the target when its estimated error and the uncertainty of that estimate together stay below it. The
// estimate is the larger of the measured distance from the reference and the C h^p of the point's own line, so that an
// error that happens to cross zero on one grid is not taken for a small one; and every finer grid of the line that was
// run must meet the target as well. Where nobody gave a reference it is the limit of three grids or more, at least one
// finer than the point; where methods tend to different limits, the target must be met against each of them.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "analysis.hpp"

namespace rouleau::study {

struct TargetDecision {
  std::optional<std::size_t> next;   ///< point to run before asking again; none: the search has ended
  bool met = false;                  ///< once it has ended
  std::optional<std::size_t> point;  ///< the cheapest that meets the target, or the one that comes nearest
  double estimated_error = std::numeric_limits<double>::quiet_NaN();
  double uncertainty = std::numeric_limits<double>::quiet_NaN();  ///< of the estimate
  std::string sentence;                                           ///< what is shown, or why nothing can be
};

/// What to do next, from what has been run so far (StudyPoint::tried) and what the rest is estimated to take. Points
/// that are estimated to take longer than `budget_s` are not asked for. The caller runs `next`, marks it as tried and
/// asks again. Ends after at most as many calls as there are points, and one.
TargetDecision decide_target(const StudyData& study, std::size_t quantity, double target,
                             double budget_s = std::numeric_limits<double>::infinity());

/// How well a point meets a target (parts of decide_target).
struct TargetBound {
  double estimate = std::numeric_limits<double>::quiet_NaN();
  double uncertainty = std::numeric_limits<double>::quiet_NaN();
  std::string why_not;  ///< why the two are not enough to trust it; empty: they are
  [[nodiscard]] double bound() const { return estimate + uncertainty; }
};
TargetBound bound_of(const StudyData& study, std::size_t quantity, const QuantityAnalysis& analysis, std::size_t point,
                     double target);

/// What a run of a point takes: as measured, else as estimated and corrected by what the estimates of its line, or of
/// all points, were wrong by. NaN where nobody knows.
double cost_of(const StudyData& study, std::size_t point);

}  // namespace rouleau::study
