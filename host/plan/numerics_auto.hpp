// "numerics": "auto": resolution, relaxation time, relaxed density and coupling chosen for a target error.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "error_model.hpp"
#include "json/json.hpp"
#include "numerics_choice.hpp"

namespace rouleau::json {
class Document;
}  // namespace rouleau::json
namespace rouleau::scene {
struct Scene;
}  // namespace rouleau::scene
namespace rouleau::plan {

/// What the limits of a plan ask for beyond the target error, and what only a plan knows, for it has opened the plugins.
struct NumericsBounds {
  std::map<std::size_t, double> most_density_factor = {};  ///< by stage
  /// By stage and relaxation time. The explicit step bears stiffness by the square of tau - 1/2, so that what is too much at one
  /// may do at another.
  std::map<std::pair<std::size_t, double>, double> most_density_factor_at = {};
  double least_radius = 0;  ///< of the smallest cell, lattice spacings; errors want more
  bool slip_correction = true;
  std::optional<RecoveryRates> recovery = {};
  bool operator==(const NumericsBounds&) const = default;
};

/// Puts values into the document of a scene that leaves its numerics open ("numerics": "auto", or an object with
/// "auto"): the cheapest that keep the target error by what was measured (docs/accuracy.md) and the bounds. What the
/// scene says of its numerics stays, so that it can be read again. Nothing for a scene that pins its numerics. A scene
/// with faults gets values with which it can be read, and nothing is chosen. Throws Error(bad_input) when no lattice fits
/// the domain.
std::optional<NumericsChoice> fill_in_numerics(json::Document& document, const NumericsBounds& bounds = {});

}  // namespace rouleau::plan
