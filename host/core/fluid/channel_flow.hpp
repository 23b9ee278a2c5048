// The developed flow of a channel without cells.
#pragma once

namespace rouleau::core {

/// Couette and Poiseuille flow along x between walls across y. Lattice units; y counts from the first row, half a spacing
/// from the lower wall.
struct ChannelFlow {
  double half_height = 0;  ///< between the walls
  double mean = 0;         ///< of the walls' velocities
  double rate = 0;         ///< du/dy in the middle
  double curvature = 0;    ///< -d2u/dy2

  [[nodiscard]] double from_middle(double y) const { return y - (half_height - 0.5); }
  [[nodiscard]] double velocity(double y) const {
    const double s = from_middle(y);
    return mean + rate * s + curvature * (half_height * half_height - s * s) / 2;
  }
  [[nodiscard]] double slope(double y) const { return rate - curvature * from_middle(y); }
};

/// What the walls and the body force of a setup without layers drive without cells; what oscillates is left out.
template <class Setup>
ChannelFlow channel_flow(const Setup& setup) {
  const int height = setup.domain.size[1];
  return {.half_height = height / 2.0,
          .mean = (setup.walls.upper + setup.walls.lower) / 2,
          .rate = (setup.walls.upper - setup.walls.lower) / height,
          .curvature = setup.body_force_x / setup.viscosity()};
}

}  // namespace rouleau::core
