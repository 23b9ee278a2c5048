// The lattice's units of length, time and mass: the one place where SI becomes lattice units and back.
#pragma once

#include <cmath>

#include "units.hpp"

namespace rouleau::units {

/// SI value of one lattice unit each. Density of the simulated fluid is 1 in lattice units.
struct LatticeUnits {
  double length;  ///< m, the spacing
  double time;    ///< s, one step
  double mass;    ///< kg

  /// Size in SI of the lattice unit of a dimension. Temperature, amount and current have no lattice unit.
  [[nodiscard]] double unit(const Dimension& d) const {
    return std::pow(mass, d.exponent[0]) * std::pow(length, d.exponent[1]) * std::pow(time, d.exponent[2]);
  }
  [[nodiscard]] double to_lattice(double si, const Dimension& d) const { return si / unit(d); }
  [[nodiscard]] double to_si(double lattice, const Dimension& d) const { return lattice * unit(d); }
};

/// Where the lattice's node `place` lies along an axis, in the spacing's unit from the domain's border: nodes are the
/// centres of squares, so the first lies half a spacing inside. Places between nodes, too.
inline double coordinate(double place, double spacing) { return (place + 0.5) * spacing; }
/// The other way round.
inline double place_on_lattice(double coordinate, double spacing) { return coordinate / spacing - 0.5; }

/// Mach number of a speed in lattice units, where that of sound is 1/sqrt(3).
inline double mach_number(double speed) { return speed * std::sqrt(3.0); }

/// Dimensions that the host itself converts.
namespace dimension {
inline constexpr Dimension number{};
inline constexpr Dimension length{{0, 1, 0, 0, 0, 0}};
inline constexpr Dimension area{{0, 2, 0, 0, 0, 0}};
inline constexpr Dimension time{{0, 0, 1, 0, 0, 0}};
inline constexpr Dimension rate{{0, 0, -1, 0, 0, 0}};
inline constexpr Dimension velocity{{0, 1, -1, 0, 0, 0}};
inline constexpr Dimension density{{1, -3, 0, 0, 0, 0}};
inline constexpr Dimension viscosity{{1, -1, -1, 0, 0, 0}};
inline constexpr Dimension pressure{{1, -1, -2, 0, 0, 0}};
inline constexpr Dimension force_density{{1, -2, -2, 0, 0, 0}};
/// Of a force in so many dimensions: in two that of one per depth.
inline constexpr Dimension force(int dimensions) { return {{1, dimensions - 2, -2, 0, 0, 0}}; }
inline constexpr Dimension tension{{1, 0, -2, 0, 0, 0}};
inline constexpr Dimension energy_per_depth{{1, 1, -2, 0, 0, 0}};
inline constexpr Dimension power_per_depth{{1, 1, -3, 0, 0, 0}};
}  // namespace dimension

}  // namespace rouleau::units
