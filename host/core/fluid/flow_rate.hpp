// The flow rate of a channel, from the mean velocity of each row.
#pragma once

#include <vector>

#include "walls.hpp"

namespace rouleau::core {

/// Integral of the velocity along x over the height, lattice units, from its mean in each row. Between walls it is exact
/// for velocities that are parabolas in y (midpoint rule with its end correction; the walls' velocity counts as a value).
double flow_rate(const std::vector<double>& row_velocities, const WallVelocity& walls, bool periodic);

}  // namespace rouleau::core
