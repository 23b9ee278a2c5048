#include "limit_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rouleau::plan {

namespace {

/// At the limit is not beyond it, however the value was rounded.
double unrounded(double margin) { return std::abs(margin - 1) < 1e-9 ? 1 : margin; }

}  // namespace

void LimitList::below(const std::string& name, double value, double limit, const std::string& remedy,
                      RemediedBy remedied_by, double power_of_density) {
  if (!std::isfinite(value)) return;
  const double margin = value > 0 ? limit / value : std::numeric_limits<double>::infinity();
  limits_.push_back({name, value, limit, unrounded(margin), remedy, remedied_by, stage_, power_of_density});
}

void LimitList::above(const std::string& name, double value, double limit, const std::string& remedy,
                      RemediedBy remedied_by) {
  if (std::isfinite(value))
    limits_.push_back({name, value, limit, unrounded(value / limit), remedy, remedied_by, stage_});
}

std::vector<Limit> LimitList::sorted() && {
  std::stable_sort(limits_.begin(), limits_.end(), [](const Limit& a, const Limit& b) { return a.margin < b.margin; });
  return std::move(limits_);
}

}  // namespace rouleau::plan
