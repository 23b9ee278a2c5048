// Finds the edge of stability of one parameter by bisection, and looks whether there is only one.
#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace rouleau::stability {

enum class Scale { logarithmic, linear };

struct SearchRange {
  double from, to;  ///< from < to; both above 0 on a logarithmic scale
  Scale scale = Scale::logarithmic;
  /// The bracket is narrow enough: a ratio (logarithmic, above 1) or a difference (linear, above 0).
  double precision = 1.1;
  bool whole = false;  ///< only whole numbers
};

/// Between a stable value and an unstable one next to each other; nothing stands where there is none.
struct StabilityEdge {
  enum class Direction { above, below } direction = Direction::above;  ///< on which side it is unstable
  std::optional<double> stable_up_to, unstable_from;
};

struct EdgeSearch {
  /// One entry where an edge was found at one side, or none; two where the range is stable in its middle only. Without
  /// an edge: one entry with only one of its two values, all stable or all unstable.
  std::vector<StabilityEdge> edges;
  std::vector<double> tried;         ///< in the order in which they were judged
  std::vector<double> out_of_order;  ///< stable beyond an edge, or unstable before it
  bool complete = true;              ///< false: a judgement was missing
};

/// Whether a value is stable; nothing: not known, the search ends there.
using Judge = std::function<std::optional<bool>(double value)>;

/// Judges both ends; bisects between a stable and an unstable one; where both are unstable, looks for a stable value at
/// the middle and the quarters first. Then one value in the middle of what lies on either side of each edge is judged:
/// what contradicts the edge is out of order. No value is judged twice.
EdgeSearch find_edges(const SearchRange& range, const Judge& judge);

/// The value as trials write it: six digits, whole where it must be.
double rounded_value(double value, bool whole);

}  // namespace rouleau::stability
