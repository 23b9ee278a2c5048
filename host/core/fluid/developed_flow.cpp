#include "developed_flow.hpp"

#include <cmath>
#include <numbers>

namespace rouleau::core {

SectionPoint DuctFlow::at(double y, double z) const {
  using std::numbers::pi;
  constexpr double negligible = 40;  // exp(-40) is less than rounding
  const double half = height / 2, from_wall = half - std::abs(y);
  const double mean = (walls.upper + walls.lower) / 2, odd = (walls.upper - walls.lower) / 2;
  SectionPoint point{force / 2 * (width * width / 4 - z * z), 0, -force * z};
  double sign = 1;
  for (int n = 1;; n += 2, sign = -sign) {
    const double a = n * pi / width;
    if (a * from_wall > negligible) break;
    // cosh(a y)/cosh(a h) and sinh(a y)/sinh(a h), h the half height, without what overflows.
    const double far = std::exp(-a * from_wall), near = std::exp(-2 * a * std::abs(y)), all = std::exp(-2 * a * half);
    const double even_part = far * (1 + near) / (1 + all), odd_part = std::copysign(far * (1 - near) / (1 - all), y);
    const double even_slope = a * std::copysign(far * (1 - near) / (1 + all), y),
                 odd_slope = a * far * (1 + near) / (1 - all);
    const double of_walls = 4 * sign / (n * pi), of_force = -4 * force * width * width * sign / std::pow(n * pi, 3);
    const double even = of_force + of_walls * mean, c = std::cos(a * z), s = std::sin(a * z);
    const double value = even * even_part + of_walls * odd * odd_part;
    point.velocity += value * c;
    point.slope_y += (even * even_slope + of_walls * odd * odd_slope) * c;
    point.slope_z -= value * a * s;
  }
  return point;
}

SectionPoint tube_flow(double radius, double force, double y, double z) {
  const double square = y * y + z * z;
  if (square >= radius * radius) return {};
  return {force / 4 * (radius * radius - square), -force / 2 * y, -force / 2 * z};
}

}  // namespace rouleau::core
