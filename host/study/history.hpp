// Numbers read off curves that a run has written row by row: values at an instant, means, passages, turns.
//
// A curve is two columns of the same length, x not falling (strain or time) unless said otherwise. Rows without a
// value (NaN) are gaps: nothing is interpolated across them.
#pragma once

#include <optional>
#include <vector>

namespace rouleau::study {

using Column = std::vector<double>;

/// Value of y where x first passes `at` (x need not be monotone), linear between rows; NaN where it never does.
double interpolated_at(const Column& x, const Column& y, double at);

/// Mean of y over x from `from` to the last row, by trapezes; NaN where x does not reach so far, or y has a gap.
double mean_from(const Column& x, const Column& y, double from);

/// What x grows by while `angle` (rad, followed over turns, either way round) turns by so many `turns`: the last ones
/// before the end, or with `from` the first ones after x = from. NaN where it does not turn so far.
double length_of_turns(const Column& x, const Column& angle, double turns, std::optional<double> from);

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
