// Names and examples of the dimensions that users of this program meet, for messages about units.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace rouleau::units {

/// Exponents of kg, m, s, K, mol and A. An angle has none.
struct Dimension {
  std::array<int, 6> exponent{};
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// "a pressure"; `of the dimension kg m-3 s-1` where it has no common name.
std::string kind_of(const Dimension& dimension);

/// `N/m (for example "6e-6 N/m" or "6e-3 dyn/cm")` for a wanted unit.
std::string wanted_unit(std::string_view unit, const Dimension& dimension);

/// Symbols of units that are usual in this field, to suggest from.
std::span<const std::string_view> usual_units();

/// Units made of several symbols that are usual in this field, to suggest from.
std::span<const std::string_view> usual_compounds();

}  // namespace rouleau::units
