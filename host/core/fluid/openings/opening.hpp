// Openings: ends of the lattice along one axis that fluid goes through.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace rouleau::core {

/// What an end of a lattice along its open axis is kept at. Its plane lies half a spacing outside the
/// outermost nodes, as a wall does. Lattice units.
struct Opening {
  enum class Kind {
    pressure,  ///< `value`: the mean pressure, above that of density 1
    velocity   ///< `value`: the mean velocity along the axis of the fluid nodes of the section (Section)
  };
  Kind kind = Kind::pressure;
  double value = 0;
};
/// Of the lower and the upper end; none: no axis is open.
using Openings = std::optional<std::array<Opening, 2>>;

/// What goes through the planes of nodes at the two ends, lattice units.
struct EndFlow {
  double flow = 0;                    ///< along the axis: the sum of the nodes' velocities
  double pressure = 0;                ///< mean of the nodes, above that of density 1
  std::vector<double> of_parts = {};  ///< the flow through each of the end's openings (parts_of_section)
};

}  // namespace rouleau::core
