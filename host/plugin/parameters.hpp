// Parameters of a scene's model, checked against the manifest: names, units, limits, usual ranges.
#pragma once

#include <string>
#include <vector>

#include "input/scene.hpp"
#include "manifest.hpp"

namespace rouleau::host {

/// Values in SI in the manifest's order (index for a choice).
struct ParameterValues {
  std::vector<double> values;
  std::vector<std::string> warnings;  ///< one sentence for each value outside its usual range
  bool inactive = false;              ///< the manifest's inactive_when holds: the model does nothing
};

/// Throws Error(bad_input) for an unknown name (nearest, and the model's list), a wrong unit, a value outside its
/// limits, or a missing parameter, each with its place in the scene.
ParameterValues resolve_parameters(const ModelChoice& choice, const Manifest& manifest, const Scene& scene,
                                   const Units& units);

}  // namespace rouleau::host
