// Parameters of a scene's model, checked against the manifest: names, units, limits, usual ranges.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "manifest.hpp"
#include "scene/scene.hpp"

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

/// Values in SI in the manifest's order (index for a choice).
struct ParameterValues {
  std::vector<double> values;
  std::vector<std::string> warnings;  ///< one sentence for each value outside its usual range
  bool inactive = false;              ///< the manifest's inactive_when holds: the model does nothing
};

/// Adds a fault for each unknown name (nearest, and the model's list), wrong unit, value outside its limits and missing
/// parameter, with its place in the scene, but for what follows from faults that are there already. With faults the
/// values mean nothing.
ParameterValues resolve_parameters(const scene::ModelChoice& choice, const Manifest& manifest,
                                   const scene::Scene& scene, const units::Units& units, Faults& faults);
/// Throws those faults, Error(bad_input).
ParameterValues resolve_parameters(const scene::ModelChoice& choice, const Manifest& manifest,
                                   const scene::Scene& scene, const units::Units& units);

}  // namespace rouleau::plugin
