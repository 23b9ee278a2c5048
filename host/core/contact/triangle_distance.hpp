// The point of a triangle that is closest to another point.
#pragma once

#include <array>

#include "core/domain/vec.hpp"

namespace rouleau::core {

/// The point weight[0] a + weight[1] b + weight[2] c of a triangle; weights are not negative and add up to 1.
struct TrianglePoint {
  std::array<double, 3> weight;
  Vec<3> place;
};

/// Inside the face, on an edge or in a corner (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
inline TrianglePoint closest_point(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
  const Vec<3> ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {{1, 0, 0}, a};
  const Vec<3> bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {{0, 1, 0}, b};
  const double in_c = d1 * d4 - d3 * d2;
  if (in_c <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {{1 - v, v, 0}, a + v * ab};
  }
  const Vec<3> cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {{0, 0, 1}, c};
  const double in_b = d5 * d2 - d1 * d6;
  if (in_b <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {{1 - w, 0, w}, a + w * ac};
  }
  const double in_a = d3 * d6 - d5 * d4;
  if (in_a <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {{0, 1 - w, w}, b + w * (c - b)};
  }
  const double inverse = 1 / (in_a + in_b + in_c), v = in_b * inverse, w = in_c * inverse;
  return {{1 - v - w, v, w}, a + v * ab + w * ac};
}

}  // namespace rouleau::core
