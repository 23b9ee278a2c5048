// The walls of a scene, as the region that they leave to the fluid.
#pragma once

#include "base/error.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// Finest sampling of the fluid's content: 2^24 parts of the domain, of which those at walls count by the share that a
/// plane wall would leave of them.
inline constexpr int content_halvings = 24;

/// Makes Domain::region_in_plane or region_in_space, its content and its width; nothing where the scene has no shapes.
/// What the shapes are made of is read from files here. None of it depends on the lattice, but on the size of the
/// domain. Adds all faults: files, meshes that are not closed, what does not fit its image one period away, no fluid.
void build_walls(scene::Scene& scene, Faults& faults);

}  // namespace rouleau::shape
