// The point of a triangle that is closest to another point.
#pragma once

#include "core/domain/vec.hpp"
#include "core/domain/vectors.hpp"

namespace rouleau::core {

/// The point weight[0] a + weight[1] b + weight[2] c of a triangle, and the vector from it to the other point; weights
/// are not negative and add up to 1.
template <class S>
struct ClosestPoint {
  S weight[3];
  Vectors<S> away;
};

/// Inside the face, on an edge or in a corner (Ericson, Real-Time Collision Detection, 2005, section 5.1.5), for
/// numbers or packs of them.
template <class S>
ROULEAU_ALWAYS_INLINE ClosestPoint<S> closest_point(const Vectors<S>& p, const Vectors<S>& a, const Vectors<S>& b,
                                                    const Vectors<S>& c) {
  const Vectors<S> ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const S d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
  const S none = 0.0, one = 1.0;
  S at_a = d3 * d6 - d5 * d4, at_b = d5 * d2 - d1 * d6, at_c = d1 * d4 - d3 * d2;
  const S beyond_bc = max(at_a, max(d3 - d4, d6 - d5)), beyond_ac = max(at_b, max(-d2, d6)),
          beyond_ab = max(at_c, max(-d1, d3));
  // Where `beyond` is not positive other weights are the right ones, of corners before edges. By products with 0 and 1:
  // g++ 12 makes single numbers of a mask that is used twice.
  const auto take = [&](const S& beyond, const S& of_a, const S& of_b, const S& of_c) {
    const S stays = select(beyond > none, one, none), goes = one - stays;
    at_a = stays * at_a + goes * of_a, at_b = stays * at_b + goes * of_b, at_c = stays * at_c + goes * of_c;
  };
  take(beyond_bc, none, d5 - d6, d4 - d3);
  take(beyond_ac, -d6, none, d2);
  take(max(-d6, d5 - d6), none, none, one);
  take(beyond_ab, -d3, d1, none);
  take(max(-d3, d4 - d3), none, one, none);
  take(max(d1, d2), one, none, none);
  const S inverse = 1.0 / (at_a + at_b + at_c), of_b = at_b * inverse, of_c = at_c * inverse;
  return {{at_a * inverse, of_b, of_c}, ap - of_b * ab - of_c * ac};
}

}  // namespace rouleau::core
