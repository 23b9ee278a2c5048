// Parameters of a scene's model, checked against the manifest: names, units, limits, usual ranges.
#pragma once

#include <string>
#include <vector>

#include "base/faults.hpp"
#include "manifest.hpp"
#include "scene/scene.hpp"

namespace rouleau::plugin {

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
