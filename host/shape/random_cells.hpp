// The cells that a scene wants at random: how many, and where.
#pragma once

#include "packing.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// Adds the cells of the scene's packings, above each other in the middle of their regions until they are placed: as
/// many as fill the share of the region that is asked for. Throws Error(bad_input) for what is hopeless before it is
/// tried.
void add_random_cells(scene::Scene& scene);

/// Places them. Throws Error(bad_input) where they do not fit.
void pack_cells(scene::Scene& scene, const PackingWatch& watch = {});

}  // namespace rouleau::shape
