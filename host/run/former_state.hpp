// The state of a run as former versions of the program kept it in their checkpoints.
#pragma once

#include "json/json.hpp"
#include "plan/plan.hpp"

namespace rouleau::run {

/// Adds what they did not say to a saved RunState: of each cell the node that tells its tank treading, which follows
/// from how it was placed, which cells an output had, and columns that there were not. What is there stays as it is.
template <int D>
void complete_former_state(nlohmann::json& run, const plan::Plan& plan);

}  // namespace rouleau::run
