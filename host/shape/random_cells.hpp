// The cells that a scene wants at random: how many, and where.
#pragma once

#include <span>

#include "packing.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// Adds the cells of the scene's packings, above each other in the middle of their regions until they are placed: as
/// many as fill the share of the region that is asked for. Throws Error(bad_input) for what is hopeless before it is
/// tried.
void add_random_cells(scene::Scene& scene);

/// Places them. Throws Error(bad_input) where they do not fit.
void pack_cells(scene::Scene& scene, const PackingWatch& watch = {});

/// Adds an entry to scene.cells for each cell that can come in while the stages last. They are not placed: their places
/// stand for none. Throws Error(bad_input) where they are more than can be computed.
void add_fed_cells(scene::Scene& scene);

/// The cells that are there at one time, about: those that are placed, and as many of the others as make up the feed's
/// hematocrit.
std::span<const scene::CellPlacement> cells_at_once(const scene::Scene& scene);

}  // namespace rouleau::shape
