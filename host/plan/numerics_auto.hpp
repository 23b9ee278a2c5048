// "numerics": "auto": resolution, relaxation time, relaxed density and coupling chosen for a target error.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rouleau::json {
class Document;
}  // namespace rouleau::json
namespace rouleau::scene {
struct Scene;
}  // namespace rouleau::scene
namespace rouleau::plan {

/// Parts of the error that is expected of a result, relative.
struct ErrorShares {
  double resolution = 0;  ///< of the lattice
  double inertia = 0;     ///< of the fluid that is simulated denser than it is
  [[nodiscard]] double total() const { return resolution + inertia; }
};

/// What the limits of a plan ask for beyond the target error.
struct NumericsBounds {
  double most_density_factor = std::numeric_limits<double>::infinity();
  double least_radius = 10;  ///< of the smallest cell, lattice spacings
  bool slip_correction = true;
  bool operator==(const NumericsBounds&) const = default;
};

struct ChosenValue {
  std::string pointer;  ///< into the scene
  nlohmann::json value;
  std::string why;
};

struct NumericsChoice {
  double target;  ///< relative error that was asked for
  bool steady;    ///< asked for the steady state, not for the motion
  ErrorShares expected;
  std::vector<ChosenValue> values;  ///< what the scene leaves open
  std::string doubt;                ///< why the target may not be met, or only at a price; empty: it should
};

/// Does the scene leave its numerics open ("numerics": "auto", or an object with "auto")? False for what is no scene.
bool leaves_numerics_open(const nlohmann::json& scene);

/// Gives "numerics": "auto" the form of an object, as the functions below want it.
void spell_out_numerics(json::Document& document);

/// Gives a scene that leaves its numerics open values with which it can be read; they mean nothing. Throws
/// Error(bad_input) when no lattice fits the domain.
void put_draft_numerics(json::Document& document);

/// The cheapest settings of those that keep the target error by what was measured (docs/accuracy.md) and the bounds.
/// `draft` is the scene with draft numerics, `written` the scene without.
NumericsChoice choose_numerics(const scene::Scene& draft, const nlohmann::json& written, const NumericsBounds& bounds);

/// Puts the chosen values into the scene; what it says about them stays, so that it can be read again.
void put_choice(json::Document& document, const NumericsChoice& choice);

}  // namespace rouleau::plan
