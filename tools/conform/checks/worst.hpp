// The worst of many comparisons of one check, and the finding that it makes.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "conform/check.hpp"

namespace rouleau::conform {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

class Worst {
 public:
  /// One comparison: passes when measured <= limit. `words()` names its place; it is asked for the worst one only,
  /// which is that of the largest measured/limit.
  template <class Words>
  void add(double measured, double limit, const Words& words) {
    ++count_;
    double ratio = measured <= 0 && limit >= 0 ? 0 : measured / limit;
    if (std::isnan(ratio)) ratio = std::numeric_limits<double>::infinity();
    if (ratio <= ratio_) return;
    ratio_ = ratio;
    measured_ = measured;
    limit_ = limit;
    what_ = words();
  }

  [[nodiscard]] bool passes() const { return ratio_ <= 1; }
  [[nodiscard]] int count() const { return count_; }

  /// `clean`: what to say when nothing was off at all.
  [[nodiscard]] Finding finding(const std::string& clean) const {
    if (count_ == 0) return Finding::passed(clean);
    if (measured_ == 0) return Finding::at_most(0, limit_, clean);
    Finding finding = Finding::at_most(measured_, limit_, what_);
    if (!passes()) finding.verdict = Verdict::fail;  // infinite or not a number beside a limit that is
    return finding;
  }

 private:
  double ratio_ = -1, measured_ = 0, limit_ = 0;
  int count_ = 0;
  std::string what_;
};

}  // namespace rouleau::conform
