// What to change where cells in contact are why a run fails.
#pragma once

#include "core/solver/surroundings.hpp"
#include "failure.hpp"
#include "plan/plan.hpp"

namespace rouleau::monitor {

/// All that helps cells that attract each other, to be done together: corrections that are off, a repulsion within
/// membranes that have none, a lower density factor, a shallower well. Tried by
/// tests/limits/check_remedies.py. Empty where nothing attracts, or all of this is done.
std::string attraction_remedy(const plan::Plan& plan, const scene::StageSetting& stage);

/// What is to be put between two cells whose membranes met, or within one: `other` may be the same.
std::string crossing_remedy(const plan::Plan& plan, const scene::StageSetting& stage, int cell, int other);

/// What is to be put between a cell and a wall that it has gone through.
std::string wall_crossing_remedy(const plan::Plan& plan, const scene::StageSetting& stage, int cell);

/// Where a potential presses on two cells by more than the lattice's fluid bears, says so in the failure: which cells,
/// how far apart, which potential, and what to do. All ranks together.
template <int D>
void blame_contact(Failure& failure, core::Surroundings<D>& around, const plan::Plan& plan,
                   const scene::StageSetting& stage);

}  // namespace rouleau::monitor
