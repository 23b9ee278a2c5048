#include "run_cost.hpp"

#include <algorithm>
#include <utility>

namespace rouleau::trial {

namespace {

/// Before anything was measured.
constexpr double usual_beside_s = 0.2;
constexpr double shortest_estimate_s = 1e-6;

std::size_t settings_shared(const Point& a, const Point& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.setting.size(); ++i) count += a.setting[i] == b.setting[i] ? 1 : 0;
  return count;
}

}  // namespace

void RunCost::learn(const Point& point, double estimated_s, double stepping_s, double process_s) {
  const double factor = stepping_s / std::max(estimated_s, shortest_estimate_s);
  known_.push_back({point, estimated_s, factor, std::max(0.0, process_s - stepping_s)});
}

double RunCost::expected_s(const Point& point, double estimated_s) const {
  if (known_.empty()) return usual_beside_s + estimated_s;
  // The run most alike is the one with most settings in common; of several the longest, where little else counts.
  const auto likeness = [&](const Known& known) {
    return std::pair(settings_shared(known.point, point), known.estimated_s);
  };
  const Known& alike = *std::max_element(known_.begin(), known_.end(),
                                         [&](const Known& a, const Known& b) { return likeness(a) < likeness(b); });
  return alike.beside_s + alike.factor * estimated_s;
}

}  // namespace rouleau::trial
