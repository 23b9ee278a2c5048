// What a potential's own functions tell of it before a run: its well, its range, its stiffness. In lattice units.
#pragma once

#include <optional>

#include "core/model/model.hpp"

namespace rouleau::plan {

/// The deepest well of a potential.
struct Well {
  double distance;    ///< where the force changes from repulsion to attraction; 0 if it attracts all the way to contact
  double depth;       ///< energy per area that it takes to come from there out of the potential
  double attraction;  ///< strongest, per area, beyond that distance
  [[nodiscard]] double width() const { return depth / attraction; }
};

struct PotentialShape {
  std::optional<Well> well;  ///< none: it attracts nowhere
  double range;              ///< the cutoff
  /// Largest d force / d distance where membranes come to rest: from the well's bottom outward; without a well over the
  /// outer half of the range, for how deep membranes get into a repulsion is the flow's affair.
  double stiffness;
};

/// Finds wells at any scale between the cutoff and a ten-millionth of it, however narrow.
PotentialShape find_shape(const core::Potential& potential);

/// Force per area at a distance; positive repels.
double force_at(const core::Potential& potential, double distance);

}  // namespace rouleau::plan
