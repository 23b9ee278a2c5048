// When aggregates come apart, from how many there are at each output.
#pragma once

#include <vector>

#include "base/curve.hpp"

namespace rouleau::study {

/// How aggregates change: the number there is from x on, until the next change.
struct CountChange {
  double time, strain;
  int count;
};

/// First strain, since the sheared stage began, at which there are `count` aggregates or more; with `for_good` the
/// first from which on there are to the end. Between the output before and this one it happened: `uncertainty` is
/// their distance. NaN where it does not happen, or had happened when shear began.
struct Dissociation {
  double strain, uncertainty;
  bool at_start;  ///< there were as many when shear began
};
/// `output_strain`: of every output of the run; shear begins at `start_time` and `start_strain`.
Dissociation dissociation(const std::vector<CountChange>& changes, const Column& output_strain, double start_time,
                          double start_strain, int count, bool for_good);

}  // namespace rouleau::study
