// The dimension of a quantity.
#pragma once

#include <array>

namespace rouleau::units {

/// Exponents of kg, m, s, K, mol and A. An angle has none.
struct Dimension {
  std::array<int, 6> exponent{};
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

}  // namespace rouleau::units
