// How far scenes are from an edge that was found.
#pragma once

#include "json/json.hpp"
#include "limits_state.hpp"

namespace rouleau::stability {

/// [{scene, value, margin, why_not}]: for each scene that has the parameter, its value in the parameter's unit and by
/// what factor it may still grow (or shrink) before it passes the nearest edge of the combinations that its settings do
/// not contradict. Values are compared as the lattice feels them, in lattice units of the stage where they are largest,
/// for resolution and density factor differ between scenes. Scenes without the parameter are left out.
nlohmann::json scene_margins(const LimitsState& state);

}  // namespace rouleau::stability
