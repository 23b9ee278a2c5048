// Places, directions, sizes and forces of a scene: a number for each of its axes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/text.hpp"

namespace rouleau::scene {

inline constexpr std::array<char, 3> axis_names{'x', 'y', 'z'};

/// Two numbers, or three. What works by components takes vectors of both kinds: there is 0 along z where there is no z.
class Vector {
 public:
  Vector() = default;
  Vector(double x, double y) : at_{x, y, 0}, dimension_(2) {}
  Vector(double x, double y, double z) : at_{x, y, z}, dimension_(3) {}
  static Vector filled(int dimension, double value) {
    Vector v;
    v.dimension_ = dimension;
    std::fill_n(v.at_.begin(), dimension, value);
    return v;
  }

  [[nodiscard]] int dimension() const { return dimension_; }
  double& operator[](std::size_t axis) { return at_[axis]; }
  double operator[](std::size_t axis) const { return at_[axis]; }
  double& x() { return at_[0]; }
  double& y() { return at_[1]; }
  [[nodiscard]] double x() const { return at_[0]; }
  [[nodiscard]] double y() const { return at_[1]; }
  [[nodiscard]] double z() const { return at_[2]; }
  [[nodiscard]] const double* begin() const { return at_.data(); }
  [[nodiscard]] const double* end() const { return at_.data() + dimension_; }
  double* begin() { return at_.data(); }
  double* end() { return at_.data() + dimension_; }
  template <int D>
  [[nodiscard]] Eigen::Matrix<double, D, 1> in() const {
    return Eigen::Matrix<double, D, 1>(at_.data());
  }

  /// Without what lies along axes beyond `dimension`.
  [[nodiscard]] Vector first(int dimension) const {
    Vector v = filled(dimension, 0);
    std::copy_n(at_.begin(), dimension, v.at_.begin());
    return v;
  }

  [[nodiscard]] double norm() const { return std::hypot(at_[0], at_[1], at_[2]); }
  [[nodiscard]] double product() const {
    double all = 1;
    for (const double along : *this) all *= along;
    return all;
  }
  [[nodiscard]] double least() const { return *std::min_element(begin(), end()); }
  [[nodiscard]] double most() const { return *std::max_element(begin(), end()); }
  [[nodiscard]] bool is_finite() const {
    return std::all_of(begin(), end(), [](double along) { return std::isfinite(along); });
  }

  Vector& operator+=(const Vector& other) {
    dimension_ = std::max(dimension_, other.dimension_);
    for (std::size_t axis = 0; axis < at_.size(); ++axis) at_[axis] += other.at_[axis];
    return *this;
  }
  Vector& operator*=(double factor) {
    for (double& along : at_) along *= factor;
    return *this;
  }
  friend Vector operator+(Vector a, const Vector& b) { return a += b; }
  friend Vector operator-(Vector a, const Vector& b) { return a += -1 * b; }
  friend Vector operator*(double factor, Vector v) { return v *= factor; }
  friend bool operator==(const Vector& a, const Vector& b) { return a.at_ == b.at_; }

 private:
  std::array<double, 3> at_{};
  int dimension_ = 0;
};

/// "10 um x 20 um" of lengths, "10 x 20" of numbers of nodes; each times `factor`.
template <class Numbers>
std::string by_axes(const Numbers& numbers, double factor = 1, int digits = 12, const char* unit = "",
                    const char* between = " x ") {
  std::string text;
  for (const auto one : numbers) text += (text.empty() ? "" : between) + number(one * factor, digits) + unit;
  return text;
}

}  // namespace rouleau::scene
