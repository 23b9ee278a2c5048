// The periodic map of many coordinates at once: Domain::wrapped() in vector registers.
#pragma once

#include <rouleau/pack.hpp>

namespace rouleau::core {

/// Largest integer not above x, for |x| < 2^51. `S`: a Pack of double.
template <class S>
ROULEAU_ALWAYS_INLINE S floor(const S& x) {
  const S shift = 6755399441055744.0, rounded = (x + shift) - shift;
  return select(rounded > x, rounded - 1.0, rounded);
}

/// The node in [0, size) that a whole number is an image of along a periodic axis.
template <class S>
ROULEAU_ALWAYS_INLINE S wrapped(const S& node, double size) {
  const S inside = node - size * floor(node * (1.0 / size));
  const S raised = select(inside < S(0.0), inside + size, inside);  // the quotient may be rounded across an integer
  return select(raised >= S(size), raised - size, raised);
}

}  // namespace rouleau::core
