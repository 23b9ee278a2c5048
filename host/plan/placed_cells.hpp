// The cells of a scene as the solver takes them, checked for room.
#pragma once

#include "core/membrane/membranes.hpp"
#include "scene/scene.hpp"

namespace rouleau::plan {

/// Membranes of a scene's cells on a lattice of the given spacing (m). Throws Error(bad_input) with the place of the
/// entry in the scene when a cell crosses itself, sticks through a wall or overlaps another cell (over periodic
/// images).
core::Membranes make_membranes(const scene::Scene& scene, double spacing);

}  // namespace rouleau::plan
