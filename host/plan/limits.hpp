// Limits of the method (stability, accuracy) that a plan is held against.
#pragma once

#include <vector>

#include "limit_list.hpp"

namespace rouleau::plan {

struct Plan;

/// Limits for this scene, sharpest first.
std::vector<Limit> find_limits(const Plan& plan);

}  // namespace rouleau::plan
