// The point of a triangle that is closest to another point, and how far away it is.
#pragma once

#include <array>

#include "core/geometry/triangle_distance.hpp"

namespace rouleau::test {

struct Closest {
  std::array<double, 3> weight;
  core::Vec<3> place;
};
inline Closest closest_on_triangle(const core::Vec<3>& p, const core::Vec<3>& a, const core::Vec<3>& b,
                                   const core::Vec<3>& c) {
  const auto of = [](const core::Vec<3>& v) { return core::Vectors<double>{v.x(), v.y(), v.z()}; };
  const auto [weight, away] = core::closest_point(of(p), of(a), of(b), of(c));
  return {{weight[0], weight[1], weight[2]}, p - core::Vec<3>(away.x, away.y, away.z)};
}

inline double distance_to_triangle(const core::Vec<3>& p, const core::Vec<3>& a, const core::Vec<3>& b,
                                   const core::Vec<3>& c) {
  return (p - closest_on_triangle(p, a, b, c).place).norm();
}

}  // namespace rouleau::test
