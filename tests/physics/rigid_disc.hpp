// Intrinsic viscosity of a rigid disc in the middle of a channel, by fundamental solutions: no lattice, no membrane.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace rouleau::test {

struct RigidDisc {
  double intrinsic_viscosity;  ///< (mean wall stress / (viscosity x shear rate) - 1) / area fraction, dilute
  double rotation;             ///< angular velocity over shear rate; -1/2 without walls
  double residual;             ///< largest error of the velocity at the boundaries, over shear rate x radius
};

/// A disc of radius 1, free of force and torque, midway between walls `height` apart that shear the fluid; images every
/// `period` along x. Method of fundamental solutions: Stokeslets periodic along x (Pozrikidis, Boundary Integral and
/// Singularity Methods, 1992, chapter 3) on a smaller circle within the disc and on lines behind the walls, fitted to
/// no slip by least squares. The stress that the disc adds at the walls is the dipole sum(f_x y) of the Stokeslets
/// within it, per area of the box: reciprocal theorem with the undisturbed flow; a disc of area pi then has the
/// intrinsic viscosity sum(f_x y) / (pi mu gamma).
inline RigidDisc rigid_disc(double height, double period, int inside, int behind) {
  using std::numbers::pi;
  const double wave = 2 * pi / period, within = 0.55, away = 0.6 * std::max(1.0, height / 12);
  struct Point {
    double x, y;
  };
  std::vector<Point> source, node;
  const int on_disc = 3 * inside, on_wall = 2 * behind;
  for (int i = 0; i < inside; ++i) {
    source.push_back({within * std::cos(2 * pi * i / inside), within * std::sin(2 * pi * i / inside)});
  }
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < behind; ++i) source.push_back({period * (i + 0.5) / behind, side * (height / 2 + away)});
  }
  for (int i = 0; i < on_disc; ++i) {
    const double angle = 2 * pi * (i + 0.3) / on_disc;
    node.push_back({std::cos(angle), std::sin(angle)});
  }
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < on_wall; ++i) node.push_back({period * i / on_wall, side * height / 2});
  }
  const auto n = static_cast<Eigen::Index>(source.size()), m = static_cast<Eigen::Index>(node.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * m + 3, 2 * n + 1);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(2 * m + 3);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Point& p = node[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      const double x = wave * (p.x - source[static_cast<std::size_t>(j)].x);
      const double y = p.y - source[static_cast<std::size_t>(j)].y;
      const double difference = std::cosh(wave * y) - std::cos(x);
      const double potential = 0.5 * std::log(2 * difference);
      const double along_x = 0.5 * wave * std::sin(x) / difference,
                   along_y = 0.5 * wave * std::sinh(wave * y) / difference;
      a(i, j) = (1 - potential - y * along_y) / (4 * pi);
      a(i, n + j) = a(m + i, j) = y * along_x / (4 * pi);
      a(m + i, n + j) = (y * along_y - potential) / (4 * pi);
    }
    if (i < on_disc) {  // disturbance = rotation - undisturbed flow (y, 0)
      a(i, 2 * n) = p.y;
      a(m + i, 2 * n) = -p.x;
      b(i) = -p.y;
    }
  }
  for (Eigen::Index j = 0; j < inside; ++j) {
    a(2 * m, j) = a(2 * m + 1, n + j) = 1;
    a(2 * m + 2, j) = -source[static_cast<std::size_t>(j)].y;
    a(2 * m + 2, n + j) = source[static_cast<std::size_t>(j)].x;
  }
  const Eigen::VectorXd f = a.colPivHouseholderQr().solve(b);
  double dipole = 0;
  for (Eigen::Index j = 0; j < inside; ++j) dipole += f(j) * source[static_cast<std::size_t>(j)].y;
  return {std::abs(dipole) / pi, f(2 * n), (a * f - b).cwiseAbs().maxCoeff()};
}

}  // namespace rouleau::test
