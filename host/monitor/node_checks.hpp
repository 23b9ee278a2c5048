// What every step asks of the membrane nodes.
#pragma once

#include <optional>

#include "core/membrane/cell_nodes.hpp"
#include "failure.hpp"
#include "plan/stage_scales.hpp"
#include "scene/scene.hpp"

namespace rouleau::monitor {

/// What to do when a run has blown up for no narrower reason.
inline std::string blown_up_remedy(const scene::Stage& stage) {
  return "lower " + stage.density_factor_key +
         " (it divides every lattice stiffness and speed), or see the margins in the scene's plan";
}

/// Sets cell and place (before its last step) of a failure to those of a node. `spacing` in m.
void locate_failure(Failure& failure, const core::CellNodes& membranes, int node, double spacing);

/// The first check that the last step failed, without its time: a node that moved further than `limit` lattice
/// spacings, is nowhere, or (`escaped`, -1: none) has left the domain.
std::optional<Failure> check_nodes(const core::CellNodes& membranes, double limit, int escaped,
                                   const plan::StageSetting& setting);

}  // namespace rouleau::monitor
