// What "numerics": "auto" has chosen for a scene.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "error_model.hpp"
#include "json/json.hpp"

namespace rouleau::plan {

/// Parts of the error that is expected of a result, relative.
struct ErrorShares {
  double resolution = 0;  ///< of the lattice
  double inertia = 0;     ///< of the fluid that is simulated denser than it is
  double start = 0;       ///< of that fluid's start from rest
  [[nodiscard]] double total() const { return resolution + inertia + start; }
  NLOHMANN_DEFINE_TYPE_INTRUSIVE_WITH_DEFAULT(ErrorShares, resolution, inertia, start)
};

struct ChosenValue {
  std::string pointer;  ///< into the scene
  nlohmann::json value;
  std::string why;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(ChosenValue, pointer, value, why)
};

/// What was chosen for a scene that leaves its numerics open, and why.
struct NumericsChoice {
  double target;  ///< relative error that was asked for
  bool steady;    ///< asked for the steady state, not for the motion
  ErrorShares expected;
  std::vector<ChosenValue> values;  ///< what the scene leaves open
  std::string doubt;                ///< why the target may not be met, or only at a price; empty: it should
  [[nodiscard]] bool has(const std::string& pointer) const {
    return std::any_of(values.begin(), values.end(),
                       [&](const ChosenValue& value) { return value.pointer == pointer; });
  }
};

/// What the limits of a plan ask for beyond the target error, and what only a plan knows, for it has opened the
/// plugins.
struct NumericsBounds {
  std::map<std::size_t, double> most_density_factor = {};  ///< by stage
  /// By stage and relaxation time. The explicit step bears stiffness by the square of tau - 1/2, so that what is too
  /// much at one may do at another.
  std::map<std::pair<std::size_t, double>, double> most_density_factor_at = {};
  double least_radius = 0;  ///< of the smallest cell, lattice spacings; errors want more
  bool slip_correction = true;
  std::optional<RecoveryRates> recovery = {};
  bool operator==(const NumericsBounds&) const = default;
};

/// Null where nothing was left open.
inline nlohmann::json to_json(const std::optional<NumericsChoice>& choice) {
  if (!choice) return {};
  return {{"target_error", choice->target},
          {"of", choice->steady ? "steady" : "motion"},
          {"values", choice->values},
          {"expected_error", choice->expected}};
}

}  // namespace rouleau::plan
