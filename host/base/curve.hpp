// Numbers read off curves that a run has followed output by output: values at an instant, means, passages, turns.
//
// A curve is two columns of the same length, x not falling (strain or time) unless said otherwise. Rows without a
// value (NaN) are gaps: nothing is interpolated across them.
#pragma once

#include <optional>
#include <vector>

namespace rouleau {

using Column = std::vector<double>;

/// Value of y where x first passes `at` (x need not be monotone), linear between rows; NaN where it never does.
double interpolated_at(const Column& x, const Column& y, double at);

/// Mean of y over x from `from` to the last row, by trapezes; NaN where x does not reach so far, or y has a gap.
double mean_from(const Column& x, const Column& y, double from);

/// What x grows by while `angle` (rad, followed over turns, either way round) turns by so many `turns`: the last ones
/// before the end, or with `from` the first ones after x = from. NaN where it does not turn so far.
double length_of_turns(const Column& x, const Column& angle, double turns, std::optional<double> from);

}  // namespace rouleau
