// Quantities with units, by UDUNITS-2 plus the few symbols of this field that it lacks (P, cP, dyn, deg, Da, kDa).
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "dimension.hpp"

namespace rouleau::units {

/// Thrown for text that is no quantity, or a quantity of the wrong dimension; what() is one sentence for the user.
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses units and quantities. Not thread-safe. The first one reads the database of UDUNITS-2, which all share.
class Units {
 public:
  Units();

  /// Dimension of a unit such as "dyn/cm". Throws UnitError.
  [[nodiscard]] Dimension dimension(std::string_view unit) const;

  /// One `unit` in coherent SI units: 1e-3 for "dyn/cm". Throws UnitError.
  [[nodiscard]] double scale(std::string_view unit) const;

  /// SI value of a quantity such as "6e-3 dyn/cm", which must have the dimension of `wanted`. Throws UnitError whose
  /// message names the quantity found, what kind it is, and examples of what is wanted.
  [[nodiscard]] double to_si(std::string_view quantity, std::string_view wanted, std::string_view name) const;

 private:
  struct System;
  std::shared_ptr<const System> system_;
};

}  // namespace rouleau::units
