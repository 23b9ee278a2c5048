// Quantities with units, by UDUNITS-2 plus the few symbols of this field that it lacks (P, cP, dyn, deg, Da, kDa).
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "dimension_names.hpp"

namespace rouleau::units {

/// The symbols of a unit in their order, parts of `unit`; nothing if it has not the shape
///   unit    = "1" | [ "1/" ] product
///   product = factor { [ "*" | "." | "·" | "-" | "/" | " per " ] factor }    with spaces anywhere between them
///   factor  = ( symbol | "(" product ")" ) [ power ]
///   power   = [ "^" | "**" ] [ sign ] digit [ digit ] | superscript digit [ superscript digit ]
/// UDUNITS 2.2.28 knows more, but takes any number for a factor ("um 2" is 2 um), which hides slips of the pen,
/// overlooks what follows a NUL or a ")" too many, and leaks the word it has just read wherever it finds out that
/// something is wrong. What has this shape, and symbols that it knows, it takes to the end.
std::optional<std::vector<std::string_view>> symbols_of(std::string_view unit);

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
