// The angle between two directions, for any number type, so that it runs in vector registers.
#pragma once

#include <rouleau/pack.hpp>

namespace rouleau::core {

/// atan2(cross, dot) of the sine and cosine of an angle, to about 4 units in the last place; 0 if both are 0; +-pi is
/// reached from either side.
/// Method: of the angle a folded into the right half plane, cos(a/2) = sqrt((1 + |cos a|)/2) and sin(a/2) =
/// sin a/(2 cos(a/2)), so that t = tan(a/4) = sin(a/2)/(1 + cos(a/2)) needs one root and one quotient. |t| <=
/// tan(pi/8), where atan(t)/t is a polynomial in t^2 (Chebyshev fit made with 50 digits, error 1.3e-18).
template <class S>
ROULEAU_ALWAYS_INLINE S turning_angle(const S& cross, const S& dot) {
  constexpr double pi = 3.14159265358979323846;
  const S square = 0.5 + 0.5 * abs(dot), half_cosine = sqrt_and_inverse(square).root;  // of cos(a/2)
  const S t = cross / (2.0 * (half_cosine + square));
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

}  // namespace rouleau::core
