// Limits of the method (stability, accuracy) that a plan is held against.
#pragma once

#include <string>
#include <vector>

#include "constants.hpp"
#include "json/json.hpp"

namespace rouleau::plan {

struct Plan;

/// The share of its content by which a cell is compressed where the flow shears it: viscosity times shear rate presses
/// on it, and the lattice's fluid gives way. Lattice units.
constexpr double compression_by_shear(double tau, double shear_rate) {
  return compression_by_rate * (tau - 0.5) * shear_rate;
}

/// The setting that "numerics": "auto" changes where a limit is exceeded.
enum class RemediedBy { nothing, density_factor, resolution };

/// A limit of the method: the scene's value, where it ends, and limit / value.
struct Limit {
  std::string name;
  double value, limit, margin;
  std::string remedy;
  RemediedBy remedied_by = RemediedBy::nothing;
  int stage = 0;  ///< whose density factor is the remedy
  /// The power of the density factor with which the value grows, or a little less than that.
  double power_of_density = 1;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(Limit, name, value, limit, margin, remedy)
};

/// Limits for this scene, sharpest first.
std::vector<Limit> find_limits(const Plan& plan);

}  // namespace rouleau::plan
