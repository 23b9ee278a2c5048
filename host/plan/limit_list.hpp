// Values of a scene against limits of the method.
#pragma once

#include <string>
#include <vector>

#include "constants.hpp"
#include "json/json.hpp"

namespace rouleau::plan {

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

/// Values against limits, of one stage after the other.
class LimitList {
 public:
  void begin_stage(int stage) { stage_ = stage; }
  /// A value that must stay below its limit, or above. One that is not finite is none.
  void below(const std::string& name, double value, double limit, const std::string& remedy,
             RemediedBy remedied_by = RemediedBy::nothing, double power_of_density = 1);
  void above(const std::string& name, double value, double limit, const std::string& remedy,
             RemediedBy remedied_by = RemediedBy::nothing);
  /// Sharpest first.
  [[nodiscard]] std::vector<Limit> sorted() &&;

 private:
  int stage_ = 0;
  std::vector<Limit> limits_;
};

}  // namespace rouleau::plan
