// Whether a value lies within a parameter's limits and its usual range.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "manifest.hpp"

namespace rouleau::plugin {

/// True if two values are the same but for the rounding of their conversion from different units.
inline bool same_quantity(double a, double b) {
  return std::abs(a - b) <= 8 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
}

/// An SI value in the parameter's own unit: "0.49 um".
std::string value_text(double si, const Parameter& parameter, const units::Units& units);

/// What a value (SI) must be but is not: "at least 0 J/m2", "above 0 m"; empty when it is within its limits.
std::string violated_limit(double value, const Parameter& parameter, const units::Units& units);

/// True if a value (SI) is outside the usual range.
bool is_unusual(double value, const Parameter& parameter);

}  // namespace rouleau::plugin
