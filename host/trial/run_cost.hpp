// How long a run will take: the plan's estimate, corrected by what other runs of the study took.
#pragma once

#include <vector>

#include "matrix.hpp"

namespace rouleau::trial {

/// A process takes some time beside its steps (reading, writing, the report), and its steps some factor of what the
/// plan expects; both are learnt from finished runs.
class RunCost {
 public:
  /// `estimated_s` is the plan's, `stepping_s` and `process_s` what a run took.
  void learn(const Point& point, double estimated_s, double stepping_s, double process_s);
  /// Expected wall time of the process of one run.
  [[nodiscard]] double expected_s(const Point& point, double estimated_s) const;

 private:
  struct Known {
    Point point;
    double estimated_s, factor, beside_s;
  };
  std::vector<Known> known_;
};

}  // namespace rouleau::trial
