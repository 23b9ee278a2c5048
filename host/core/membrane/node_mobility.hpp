// How the nodes of a membrane give way to forces beyond what the fluid on the lattice does.
#pragma once

namespace rouleau::core {

/// What the slip correction adds to the motion of a cell type's nodes; zero without it. Lattice units.
struct NodeMobility {
  /// Distance inside the membrane at which forces act and velocities are read.
  double shift = 0;
  /// Velocity per tangential force per length.
  double slip = 0;
};

/// How a membrane's forces come back to it through the kernel that spreads them and reads velocities.
struct KernelResponse {
  /// How many times farther a force moves its own node at once than through the 4-point kernel: the sum of squares of
  /// the kernel's weights, over 3/8.
  double gain = 1;
  /// The largest k^2 f^2 and k^4 f^2, f the kernel's transform: by f^2 less a wave of wave number k pulls at itself.
  double stretching = 0.67, bending = 1.62;

  /// Of a membrane that gives way `factor` times as far to all waves.
  [[nodiscard]] KernelResponse times(double factor) const {
    return {factor * gain, factor * stretching, factor * bending};
  }
};

/// How many times stiffer a membrane with segments of this length (spacings) is to the fluid where its forces act at
/// the distance `shift`: the couples of the shift and their adjoint both gain sin(q) shift/length at q a segment.
inline double stiffening(double shift, double length) { return 1 + (shift / length) * (shift / length); }

}  // namespace rouleau::core
