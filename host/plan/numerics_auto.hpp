// "numerics": "auto": resolution, relaxation time, relaxed density and coupling chosen for a target error.
#pragma once

#include <limits>
#include <optional>

#include "scene/numerics_choice.hpp"

namespace rouleau::json {
class Document;
}  // namespace rouleau::json
namespace rouleau::plan {

/// What the limits of a plan ask for beyond the target error.
struct NumericsBounds {
  double most_density_factor = std::numeric_limits<double>::infinity();
  double least_radius = 10;  ///< of the smallest cell, lattice spacings
  bool slip_correction = true;
  bool operator==(const NumericsBounds&) const = default;
};

/// Puts values into the document of a scene that leaves its numerics open ("numerics": "auto", or an object with
/// "auto"): the cheapest that keep the target error by what was measured (docs/accuracy.md) and the bounds. What the
/// scene says of its numerics stays, so that it can be read again. Nothing for a scene that pins its numerics. Throws
/// Error(bad_input) when no lattice fits the domain, or for a fault of the scene.
std::optional<scene::NumericsChoice> fill_in_numerics(json::Document& document, const NumericsBounds& bounds = {});

}  // namespace rouleau::plan
