// The cells that come in through an inlet while a run goes on: how many.
#pragma once

#include <span>

#include "scene/scene.hpp"

namespace rouleau::shape {

/// Adds an entry to scene.cells for each cell that can come in while the stages last. They are not placed: their places
/// stand for none. Throws Error(bad_input) where they are more than can be computed.
void add_fed_cells(scene::Scene& scene);

/// The cells that are there at one time, about: those that are placed, and as many of the others as make up the feed's
/// hematocrit.
std::span<const scene::CellPlacement> cells_at_once(const scene::Scene& scene);

}  // namespace rouleau::shape
