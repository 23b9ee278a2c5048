// Layers of other viscosities in the suspending fluid, along the walls.
#pragma once

#include <vector>

#include "oscillation.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// The fluid between two heights. Lattice units; `from` and `to` from the lower edge of the lattice, half a spacing
/// below the first row of nodes.
struct Layer {
  double from, to;
  double viscosity_ratio;  ///< over the suspending fluid's
};

/// Viscosity of each of `rows` rows of a lattice over the suspending fluid's; empty without layers. A row that a border
/// cuts has the harmonic mean, by shares of its height: stress is the same on both sides, and slopes add up.
std::vector<double> viscosity_of_rows(const std::vector<Layer>& layers, int rows);

/// Relaxation rate 1/tau of a fluid that is `viscosity_ratio` times as viscous as one with `relaxation_rate`.
double rate_of_layer(double relaxation_rate, double viscosity_ratio);

/// Steady flow between walls of a fluid whose rows have these viscosities over `viscosity`: velocity and slope in the
/// middle of each row. Its stress is linear in y, and du/dy is the stress over the row's viscosity.
std::vector<ProfilePoint> layered_profile(const std::vector<double>& viscosity_of_rows, double viscosity,
                                          const WallVelocity& walls, double body_force_x);

}  // namespace rouleau::core
