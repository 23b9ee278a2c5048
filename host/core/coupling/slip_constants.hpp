// Constants of the slip correction, from the one-dimensional analysis of a membrane that a kernel has smeared out.
#pragma once

#include "kernel_kind.hpp"

namespace rouleau::core {

/// A plane membrane with tangential force f per length between fluidities b_o = 1 outside and b_i = 1/ratio inside
/// (in units of 1/viscosity outside; Db = b_o - b_i). Y, Y', Y'' are distributed as the kernel, Z as the
/// indicator's edge, smoothed or not. Smearing delays the membrane by slip x f:
///     slip = b_i m + Db r(d),   m = E max(Y, Y'),   r(d) = E max(Y, Y', Z + d) - E max(Y, Z + d),
/// once force and velocity act at a distance d inside the membrane such that  Db E max(Y - d, Z) = b_i d,  where the
/// kink of the velocity and the jump between both fluids vanish (docs: physics, slip correction).
struct SlipConstants {
  double shift;  ///< d, lattice spacings towards the inside; negative for a ratio below 1
  double slip;   ///< velocity per tangential force per length, times the viscosity outside; lattice spacings
};

/// `viscosity_ratio`: inside over outside; the mean of viscosities must be the harmonic one. `dimension` decides on the
/// edge (smooths_edges).
SlipConstants slip_constants(KernelKind kernel, double viscosity_ratio, int dimension);

/// How many times as far a membrane gives way to its own waves when forces act and velocities are read at the distance
/// `shift` d: the couple and its adjoint both add k d times what the force does, so that k^4 f^2 (f the kernel's
/// transform), by which a bending wave of wave number k pulls at itself, becomes k^4 f^2 (1 + k^2 d^2). The ratio of
/// the largest of both; for waves of stretching, which are longer, it is a tenth less.
double shift_gain(KernelKind kernel, double shift);

/// How membranes come back to their own forces through the kernel and, unless the shift is 0, through those couples.
KernelResponse kernel_response(KernelKind kernel, double shift);

/// How often the slip of an outline with segments of this length is smoothed by (1/4, 1/2, 1/4), so that a step stays
/// stable and slip is spread over about a lattice spacing: the fluid does not damp what the kernel cannot see. A
/// tangential displacement that the membrane's stiffness meets by s/l^2, s = 4 sin^2(q/2) for the wave number q per
/// segment, gains in a step the slip -C s (1 - s/4)^p times itself after p smoothings, with C = mobility x
/// stiffness/l^2. That must stay below 2 for all s in an explicit step, and below 2/3 in a semi-implicit one, whose
/// forces belong to the end of the step; 0.3 is kept. Each smoothing adds length^2/2 to the variance over which slip is
/// spread along the membrane.
int outline_slip_smoothings(double length, double mobility, double stiffness);

/// The same of surfaces, by the order n of a sum of Chebyshev's polynomials in 1 - s/3, s from 0 to 6 (SurfaceSlip):
/// the slip -C s (1 - T_n(1 - s/3)) 3/(n^2 s) takes n - 1 steps where powers would take n^2/2.7. `square_of_length`: of
/// a triangle's side.
int surface_slip_smoothing(double square_of_length, double mobility, double stiffness);

}  // namespace rouleau::core
