// The part of a membrane's tension that grows with the stretch rate, by a step that is stable at any viscosity.
#pragma once

namespace rouleau::core {

/// One cell's segments. A tension T = eta r, r = g/L the stretch rate, is felt by the nodes at both ends, so that it
/// changes the rate of length g at once; explicit steps therefore fail from eta near 1 lattice unit on. With D the
/// second difference along the membrane, (D T)_i = t_i.(F_i+1 - F_i) for F_i = T_i t_i - T_i-1 t_i-1, and M the
/// velocity that a node gains in a step from a force of 1, the new tension solves
///
///     T - (eta/L) M D T = eta r - (eta/L) M D T_old,
///
/// cyclic, tridiagonal and diagonally dominant. Its fixed point is T = eta r: no viscosity is lost. D is symmetric and
/// not positive, hence sum T g >= M/2 (sum T (-D) T - the same of T_old): whatever the step, what the membrane gives
/// back it has taken before, and that is a small part of what it dissipates (docs: physics, membrane viscosity).
struct TensionRateStep {
  int count;
  const double *tangent_x, *tangent_y;
  const double* inverse_rest_length;
  const double* rate;     ///< r
  const double* by_rate;  ///< eta, not negative
  double mobility;        ///< M
  double* tension;        ///< T_old, and T when done
  double* workspace[4];   ///< of `count` each
};

void solve(const TensionRateStep& step);

/// Velocity that a node gains in one step from a force of 1 on it and all its like, in lattice units. 4-point kernel:
/// measured stable from 2 to 16 with one segment for each spacing (docs/accuracy.md); nodes that lie closer drag the
/// same fluid together.
double rate_mobility(double mean_rest_length);

}  // namespace rouleau::core
