// The wave that runs along a membrane beside its smooth motion: how long it is, and which way the nodes move in it.
#pragma once

#include <limits>
#include <span>

namespace rouleau::monitor {

/// Waves shorter than this share of the outline are no longer counted as its smooth motion.
inline constexpr int smooth_wave_numbers = 4;

struct MembraneWave {
  /// Segments; of the wave number with the largest energy. NaN: there is none.
  double wavelength = std::numeric_limits<double>::quiet_NaN();
  double tangential_share =
      std::numeric_limits<double>::quiet_NaN();  ///< of the energy of all waves; the rest is normal
  /// Largest speed of a node in the waves alone, over the largest speed of a node: 1 where nothing else moves.
  double prominence = 0;
  double speed = 0;  ///< the former of the two, in the velocities' unit
};

/// Nodes of one closed outline in their order, with their velocities. From these the uniform velocity gradient that
/// fits them best is taken away (translation, rotation and the shear of the flow), the rest is split into components
/// along and across the outline, and each is transformed over the nodes' numbers; waves are what has more than
/// smooth_wave_numbers periods around the outline. Fewer than 12 nodes, or a value that is no number: no wave.
MembraneWave find_wave(std::span<const double> x, std::span<const double> y, std::span<const double> velocity_x,
                       std::span<const double> velocity_y);

}  // namespace rouleau::monitor
