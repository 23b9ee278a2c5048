// The flow rate of a channel, from the mean velocity of each row.
#pragma once

#include <vector>

#include "core/domain/domain.hpp"
#include "walls.hpp"

namespace rouleau::core {

/// Integral of the velocity along Domain::flow_axis over the cross-section (the height, in two dimensions), lattice
/// units, from its mean in each row. Between walls it is exact for velocities that are parabolas from wall to wall
/// (midpoint rule with its end correction; the walls' velocity counts as a value). `solid`: solid nodes are at the
/// walls, and there is no correction.
template <int D>
double flow_rate(const std::vector<double>& row_velocities, const WallVelocity& walls, const Domain<D>& domain,
                 bool solid = false);

}  // namespace rouleau::core
