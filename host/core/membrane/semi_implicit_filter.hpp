// The semi-implicit step of stiff membranes: forces that already know how the fluid will give way to them.
#pragma once

#include <vector>

namespace rouleau::core {

/// Velocity that a node of a membrane gains in a step from a force of 1 on each unit of its measure at rest (length of
/// an outline, area of a surface): a layer of two spacings goes along.
constexpr double node_mobility = 0.5;

/// Steps over which the mean goes that a semi-implicit step holds: with the largest eigenvalue of m K, and the
/// kinematic viscosity of the fluid around the cell in lattice units.
double steps_of_mean(double largest_eigenvalue, double viscosity);

/// With forces F(X) of a membrane whose stiffness is about K = k_s/l D2 + k_b/l^3 D4 (D2, D4: second and fourth
/// differences around the cell, both positive), and m the velocity that a node gains in a step from a force of 1,
///
///     F = H + (I + m K)^-1 (F(X + V) - H),   m = 1/(2 l),
///
/// is the force at the end of a step in which the nodes move by V + m (F - H) (V: the last step's). H is what the fluid
/// has long answered to: the mean of F(X + V) over the last 1 + 8 |m K| steps or so, |m K| its largest eigenvalue. Only
/// what changes faster is held back, and membranes come to rest where their own forces balance those of others.
///
/// A line of forces drags a layer of 8/3 spacings with the 4-point kernel, which would make m = 3/(8 l); the step is
/// stable while the m taken is a little more than the true one (docs/accuracy.md), and fails below relaxation times of
/// 0.6 whatever it is. K is the same around the cell, so that the sum of the forces stays what it is, zero; their
/// torque need not (docs: physics, stiff membranes).
class SemiImplicitFilter {
 public:
  /// `stretching`: k_s = d tension / d stretch; `bending`: k_b = d moment / d curvature; `length`: l, the mean rest
  /// length of `count` >= 6 segments; `gain`: how many times further a force moves its node than m says; `viscosity`:
  /// kinematic, of the fluid around the cell. Lattice units.
  SemiImplicitFilter(int count, double length, double gain, double viscosity, double stretching, double bending);

  /// Replaces both components of a cell's forces F(X + V) by F, after taking them into their means `held_x`, `held_y`.
  void apply(double* force_x, double* force_y, double* held_x, double* held_y) const;

 private:
  // I + m K is cyclic and has five diagonals. All but the last two unknowns: L D L^T with two diagonals below the main
  // one; the last two: a border of two columns, eliminated beforehand.
  void solve_band(double* x, double* y) const;
  /// Replaces both components by (I + m K)^-1 of them.
  void solve(double* x, double* y) const;

  std::size_t band_;                                 ///< unknowns in the band
  double near_, far_;                                ///< I + m K beside the diagonal and beyond
  double share_;                                     ///< of the newest force in the mean
  std::vector<double> lower_, lowest_, inverse_;     ///< L's diagonals below the main one, and 1/D
  std::vector<double> border_second_, border_last_;  ///< band^-1 times the border's columns
  double corner_[3];                                 ///< inverse of the 2 x 2 matrix that is left: 00, 01 = 10, 11
};

}  // namespace rouleau::core
