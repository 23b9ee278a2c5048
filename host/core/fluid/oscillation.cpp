#include "oscillation.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace rouleau::core {

double Oscillation::at(double t) const {
  if (ramp != 0) return std::clamp(2 * t / ramp - 1, -1.0, 1.0);
  const double periods = frequency * t;
  return std::sin(2 * std::numbers::pi * (periods - std::floor(periods)));
}

ProfilePoint oscillating_profile(const Oscillation& oscillation, double viscosity, double height, double y) {
  using Complex = std::complex<double>;
  // Everything is the imaginary part of a complex amplitude times exp(i omega t).
  const Complex i_omega(0, 2 * std::numbers::pi * oscillation.frequency), k = std::sqrt(i_omega / viscosity);
  const double h = height / 2;
  const double together = (oscillation.walls.upper + oscillation.walls.lower) / 2,
               apart = (oscillation.walls.upper - oscillation.walls.lower) / 2;
  // exp(k (y - h)) and exp(-k (y + h)) are at most 1, however thin the layers.
  const Complex up = std::exp(k * (y - h)), down = std::exp(-k * (y + h)), both = std::exp(-2.0 * k * h);
  const Complex cosh = (up + down) / (1.0 + both), sinh = (up - down) / (1.0 - both);  // over their values at the wall
  const Complex cosh_slope = k * (up - down) / (1.0 + both), sinh_slope = k * (up + down) / (1.0 - both);
  const Complex pushed = oscillation.body_force_x / i_omega;
  return {(together * cosh + apart * sinh + pushed * (1.0 - cosh)).imag(),
          (together * cosh_slope + apart * sinh_slope - pushed * cosh_slope).imag()};
}

}  // namespace rouleau::core
