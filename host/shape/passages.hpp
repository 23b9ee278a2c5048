// Ways between walls, as the lattice sees them.
#pragma once

#include "base/error.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// Lattices with more nodes are not looked through, which would take minutes.
inline constexpr double most_surveyed = 1 << 27;
/// Passages of so many spacings (of the finer lattice that small ones are looked through on) are not narrow.
inline constexpr double widest_told = 256;

/// Makes Domain::passages of a scene with shapes; `known`: that of the same lattice, or null.
void survey_walls(scene::Scene& scene, const std::shared_ptr<const scene::Passages>& known = {});

}  // namespace rouleau::shape
