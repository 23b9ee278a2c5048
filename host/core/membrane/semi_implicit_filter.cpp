#include "semi_implicit_filter.hpp"

#include <algorithm>

namespace rouleau::core {

namespace {

// Steps that the mean goes over, for a largest eigenvalue of m K of 1, where the fluid is as viscous as at tau 1. A
// thinner fluid gives way further to a force that lasts. Measured (docs/accuracy.md): the fewer, the nearer are the
// edges of stability, by up to forty times with 1/4; the more, the more is held back of forces that move along a cell.
constexpr double steps_held = 8;

}  // namespace

double steps_of_mean(double largest_eigenvalue, double viscosity) {
  return 1 + steps_held * std::max(1.0, 1 / (6 * viscosity)) * largest_eigenvalue;
}

SemiImplicitFilter::SemiImplicitFilter(int count, double length, double gain, double viscosity, double stretching,
                                       double bending)
    : band_(static_cast<std::size_t>(count) - 2) {
  const double mobility = node_mobility * gain / length;
  const double second = mobility * stretching / length, fourth = mobility * bending / (length * length * length);
  const double diagonal = 1 + 2 * second + 6 * fourth;
  near_ = -second - 4 * fourth;
  far_ = fourth;
  share_ = 1 / steps_of_mean(4 * second + 16 * fourth, viscosity);

  const std::size_t n = band_;
  for (auto* values : {&lower_, &lowest_, &inverse_, &border_second_, &border_last_}) values->assign(n, 0.0);
  std::vector<double> pivot(n);
  for (std::size_t i = 0; i < n; ++i) {
    pivot[i] = diagonal;
    if (i > 1) {
      lowest_[i] = far_ * inverse_[i - 2];
      pivot[i] -= lowest_[i] * lowest_[i] * pivot[i - 2];
    }
    if (i > 0) {
      lower_[i] = (near_ - (i > 1 ? lowest_[i] * lower_[i - 1] * pivot[i - 2] : 0)) * inverse_[i - 1];
      pivot[i] -= lower_[i] * lower_[i] * pivot[i - 1];
    }
    inverse_[i] = 1 / pivot[i];
  }
  border_second_[n - 1] += near_;
  border_second_[n - 2] += far_;
  border_second_[0] += far_;
  border_last_[n - 1] += far_;
  border_last_[0] += near_;
  border_last_[1] += far_;
  solve_band(border_second_.data(), border_last_.data());

  const std::vector<double>&b = border_second_, &c = border_last_;
  const double s00 = diagonal - near_ * b[n - 1] - far_ * (b[n - 2] + b[0]);
  const double s01 = near_ - near_ * c[n - 1] - far_ * (c[n - 2] + c[0]);
  const double s11 = diagonal - far_ * c[n - 1] - near_ * c[0] - far_ * c[1];
  const double determinant = s00 * s11 - s01 * s01;
  corner_[0] = s11 / determinant;
  corner_[1] = -s01 / determinant;
  corner_[2] = s00 / determinant;
}

void SemiImplicitFilter::solve_band(double* x, double* y) const {
  const std::size_t n = band_;
  x[1] -= lower_[1] * x[0];
  y[1] -= lower_[1] * y[0];
  for (std::size_t i = 2; i < n; ++i) {
    x[i] -= lower_[i] * x[i - 1] + lowest_[i] * x[i - 2];
    y[i] -= lower_[i] * y[i - 1] + lowest_[i] * y[i - 2];
  }
  for (std::size_t i = 0; i < n; ++i) {
    x[i] *= inverse_[i];
    y[i] *= inverse_[i];
  }
  x[n - 2] -= lower_[n - 1] * x[n - 1];
  y[n - 2] -= lower_[n - 1] * y[n - 1];
  for (std::size_t i = n - 2; i-- > 0;) {
    x[i] -= lower_[i + 1] * x[i + 1] + lowest_[i + 2] * x[i + 2];
    y[i] -= lower_[i + 1] * y[i + 1] + lowest_[i + 2] * y[i + 2];
  }
}

void SemiImplicitFilter::solve(double* x, double* y) const {
  solve_band(x, y);
  const std::size_t n = band_;
  for (double* f : {x, y}) {
    const double second = f[n] - near_ * f[n - 1] - far_ * (f[n - 2] + f[0]);
    const double last = f[n + 1] - far_ * f[n - 1] - near_ * f[0] - far_ * f[1];
    f[n] = corner_[0] * second + corner_[1] * last;
    f[n + 1] = corner_[1] * second + corner_[2] * last;
    for (std::size_t i = 0; i < n; ++i) f[i] -= border_second_[i] * f[n] + border_last_[i] * f[n + 1];
  }
}

void SemiImplicitFilter::apply(double* force_x, double* force_y, double* held_x, double* held_y) const {
  const std::size_t count = band_ + 2;
  const auto take_in = [&](double* force, double* held) {
    for (std::size_t i = 0; i < count; ++i) {
      held[i] += share_ * (force[i] - held[i]);
      force[i] -= held[i];
    }
  };
  take_in(force_x, held_x);
  take_in(force_y, held_y);
  solve(force_x, force_y);
  for (std::size_t i = 0; i < count; ++i) {
    force_x[i] += held_x[i];
    force_y[i] += held_y[i];
  }
}

}  // namespace rouleau::core
