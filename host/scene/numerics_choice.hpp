// What was chosen for a scene that leaves its numerics open, and why.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rouleau::scene {

/// Parts of the error that is expected of a result, relative.
struct ErrorShares {
  double resolution = 0;  ///< of the lattice
  double inertia = 0;     ///< of the fluid that is simulated denser than it is
  [[nodiscard]] double total() const { return resolution + inertia; }
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

}  // namespace rouleau::scene
