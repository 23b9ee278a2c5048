// Flows between two walls and in tubes whose velocity is known exactly, and the distance of a field from it.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace rouleau::study {

/// Start-up of the flow between walls that begin to move with -U and +U: velocity over U; y from -1/2 to 1/2 of the
/// height, t in height^2/(kinematic viscosity). Steady for infinite t.
inline double couette_start(double y, double t) {
  double u = 2 * y;
  for (int n = 1; n < 200; ++n) {
    const double k = 2 * std::numbers::pi * n;
    u += 2 * (n % 2 == 0 ? 1 : -1) * 2 / k * std::sin(k * y) * std::exp(-k * k * t);
  }
  return u;
}

/// Start-up of the flow driven by a constant force between walls at rest, in units of the steady maximum; y from 0
/// to 1.
inline double poiseuille_start(double y, double t) {
  double u = 4 * y * (1 - y);
  for (int n = 1; n < 400; n += 2) {
    const double k = std::numbers::pi * n;
    u -= 32 / (k * k * k) * std::sin(k * y) * std::exp(-k * k * t);
  }
  return u;
}

/// Start-up of the flow that a constant force drives through a tube at rest, in units of the steady maximum; `distance`
/// from the axis in radii, t in radius^2/(kinematic viscosity). Steady for infinite t; 0 beyond the wall. Szymanski, J.
/// Math. Pures Appl. 11 (1932).
inline double tube_start(double distance, double t) {
  if (!(distance < 1)) return 0;
  double u = 1 - distance * distance;
  for (int n = 1; n < 100; ++n) {
    // The n-th root of the Bessel function J0: McMahon's first term, then Newton's steps.
    double root = (n - 0.25) * std::numbers::pi;
    for (int i = 0; i < 4; ++i) root += std::cyl_bessel_j(0, root) / std::cyl_bessel_j(1, root);
    const double left = std::exp(-root * root * t);
    if (left < 1e-18) break;
    u -= 8 * std::cyl_bessel_j(0, root * distance) / (root * root * root * std::cyl_bessel_j(1, root)) * left;
  }
  return u;
}

/// |value - exact| / |exact|, root of the sums of squares.
inline double relative_l2(const std::vector<double>& value, const std::vector<double>& exact) {
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    error += (value[i] - exact[i]) * (value[i] - exact[i]);
    norm += exact[i] * exact[i];
  }
  return std::sqrt(error / norm);
}

}  // namespace rouleau::study
