// Parameters of a scene's model, checked against the manifest: names, units, limits, usual ranges.
#pragma once

#include <string>
#include <vector>

#include "manifest.hpp"
#include "scene/scene.hpp"

namespace rouleau::plugin {

/// Values in SI in the manifest's order (index for a choice).
struct ParameterValues {
  std::vector<double> values;
  std::vector<std::string> warnings;  ///< one sentence for each value outside its usual range
  bool inactive = false;              ///< the manifest's inactive_when holds: the model does nothing
};

/// Throws Error(bad_input) for an unknown name (nearest, and the model's list), a wrong unit, a value outside its
/// limits, or a missing parameter, each with its place in the scene.
ParameterValues resolve_parameters(const scene::ModelChoice& choice, const Manifest& manifest,
                                   const scene::Scene& scene, const units::Units& units);

}  // namespace rouleau::plugin
