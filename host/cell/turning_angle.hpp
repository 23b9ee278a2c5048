// The angle between two directions, for any number type, so that it runs in vector registers.
#pragma once

#include <rouleau/pack.hpp>

namespace rouleau::host {

/// atan2(cross, dot) to about 4 units in the last place; 0 if both are 0; +-pi is reached from either side.
/// Method: tan(a/2) = cross / (length + |dot|) lies in [-1, 1] and belongs to the angle folded into the right half
/// plane; one more halving brings it to |t| <= tan(pi/8), where atan(t)/t is a polynomial in t^2 (Chebyshev fit made
/// with 50 digits, error 1.3e-18).
template <class S>
ROULEAU_ALWAYS_INLINE S turning_angle(const S& cross, const S& dot) {
  constexpr double pi = 3.14159265358979323846;
  const S size = sqrt(cross * cross + dot * dot) + abs(dot);
  const S half = select(size > S(0.0), cross / size, S(0.0));
  const S t = half / (1.0 + sqrt(1.0 + half * half));
  const S z = t * t;
  S p = -0.017805397205404436408;
  p = p * z + 0.037965257453852393342;
  p = p * z - 0.050351024566010252576;
  p = p * z + 0.058468782973307570814;
  p = p * z - 0.066629518136291744146;
  p = p * z + 0.07692045330902223589;
  p = p * z - 0.090908968090640270002;
  p = p * z + 0.11111110744919658234;
  p = p * z - 0.14285714279250244942;
  p = p * z + 0.19999999999940891462;
  p = p * z - 0.33333333333333121163;
  const S folded = 4.0 * (t + t * z * p);
  const S straight = select(cross < S(0.0), S(-pi), S(pi));
  return select(dot < S(0.0), straight - folded, folded);
}

}  // namespace rouleau::host
