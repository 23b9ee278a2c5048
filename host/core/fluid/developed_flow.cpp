#include "developed_flow.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "relaxation.hpp"

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

std::vector<double> viscosity_of_rows(const std::vector<Layer>& layers, int rows) {
  if (layers.empty()) return {};
  std::vector<double> viscosity;
  for (int row = 0; row < rows; ++row) {
    double fluidity = 0, rest = 1;  // 1/viscosity, and the share of the row that no layer has
    for (const Layer& layer : layers) {
      const double share = std::min(layer.to, row + 1.0) - std::max(layer.from, static_cast<double>(row));
      if (!(share > 1e-9)) continue;  // borders on a row's edge may be off by rounding
      fluidity += share / layer.viscosity_ratio;
      rest -= share;
    }
    viscosity.push_back(rest == 1 ? 1 : 1 / (fluidity + (rest > 1e-9 ? rest : 0)));
  }
  return viscosity;
}

double rate_of_layer(double relaxation_rate, double viscosity_ratio) {
  if (viscosity_ratio == 1) return relaxation_rate;
  return 1 / relaxation_time_of(viscosity_ratio * viscosity_of(1 / relaxation_rate));
}

std::vector<ProfilePoint> layered_profile(const std::vector<double>& viscosity_of_rows, double viscosity,
                                          const WallVelocity& walls, double body_force_x) {
  // The stress is that at the lower wall less force times y; what the walls' speeds leave of it follows from
  // u(top) - u(bottom) = sum of the rows' mean stress over viscosity.
  double fluidity = 0, bent = 0, y = 0;
  for (const double ratio : viscosity_of_rows) {
    fluidity += 1 / (ratio * viscosity);
    bent += body_force_x * (y + 0.5) / (ratio * viscosity);
    y += 1;
  }
  double stress = (walls.upper - walls.lower + bent) / fluidity, u = walls.lower;
  std::vector<ProfilePoint> profile;
  for (const double ratio : viscosity_of_rows) {
    const double mu = ratio * viscosity, middle = stress - body_force_x / 2;
    profile.push_back({u + (stress + middle) / 4 / mu, middle / mu});
    u += middle / mu;
    stress -= body_force_x;
  }
  return profile;
}

namespace {

/// What the sum of a profile between walls misses of its integral.
double end_correction(const std::vector<double>& profile, double lower_wall, double upper_wall) {
  // Slopes at the walls of parabolas through the wall and the two rows nearest to it, rows at 1/2 and 3/2.
  const auto slope = [](double wall, double first, double second) { return -8 * wall / 3 + 3 * first - second / 3; };
  const std::size_t last = profile.size() - 1;
  const double lower = slope(lower_wall, profile[0], profile[1]);
  const double upper = -slope(upper_wall, profile[last], profile[last - 1]);
  return (upper - lower) / 24;
}

}  // namespace

template <int D>
double flow_rate(const std::vector<double>& row_velocities, const WallVelocity& walls, const Domain<D>& domain,
                 bool solid) {
  double sum = 0;
  for (const double velocity : row_velocities) sum += velocity;
  const double of_sum = static_cast<double>(domain.size[0]) / domain.size[domain.flow_axis()];
  if (solid) return of_sum * sum;
  const auto rows = static_cast<int>(row_velocities.size());
  double corrected = sum;
  for (int axis = 1, apart = 1; axis < D; apart *= domain.size[axis++]) {
    if (!domain.walled(axis)) continue;
    // The velocity by the place along this axis, summed over the other one.
    const int size = domain.size[axis];
    std::vector<double> profile(static_cast<std::size_t>(size));
    for (int i = 0; i < rows; ++i) profile[i / apart % size] += row_velocities[i];
    const int others = rows / size;
    corrected += end_correction(profile, axis == 1 ? others * walls.lower : 0, axis == 1 ? others * walls.upper : 0);
  }
  return of_sum * corrected;
}

template double flow_rate(const std::vector<double>&, const WallVelocity&, const Domain<2>&, bool);
template double flow_rate(const std::vector<double>&, const WallVelocity&, const Domain<3>&, bool);

}  // namespace rouleau::core
