// Vorticity from the velocities at the nodes of a grid that a file has.
#pragma once

#include <array>
#include <cstddef>

namespace rouleau::report {

/// Where velocities are known.
struct VelocityGrid {
  std::size_t nx, ny;
  std::array<double, 2> spacing;
  std::array<bool, 2> periodic;  ///< the last node's neighbour is the first

  /// dv/dx - du/dy at node (x, y) by central differences; at the ends of an axis that is not periodic, one-sided ones
  /// of second order. `u` and `v` are asked for the components at nodes, as u(x, y).
  template <class U, class V>
  double vorticity(std::size_t x, std::size_t y, const U& u, const V& v) const {
    return rise(x, nx, periodic[0], [&](std::size_t i) { return v(i, y); }) / (2 * spacing[0]) -
           rise(y, ny, periodic[1], [&](std::size_t j) { return u(x, j); }) / (2 * spacing[1]);
  }

 private:
  /// What a quantity rises over two spacings around node `i` of `n`.
  template <class Quantity>
  static double rise(std::size_t i, std::size_t n, bool is_periodic, const Quantity& value) {
    if (is_periodic || (i > 0 && i + 1 < n)) return value((i + 1) % n) - value((i + n - 1) % n);
    if (n < 3) return 0;
    return i == 0 ? 4 * value(1) - 3 * value(0) - value(2) : 3 * value(i) - 4 * value(i - 1) + value(i - 2);
  }
};

}  // namespace rouleau::report
