// Ways between walls, as the lattice sees them.
#pragma once

#include "base/error.hpp"
#include "scene/scene.hpp"

namespace rouleau::shape {

/// Lattices with more nodes are not looked through, which would take minutes.
inline constexpr double most_surveyed = 1 << 27;
/// Passages of so many spacings (of the finer lattice that small ones are looked through on) are not narrow.
inline constexpr double widest_told = 256;

/// A wall between two neighbouring nodes of the fluid that holds none itself: the flow goes through it.
struct UnseenWall {
  double thickness = 0;   ///< spacings, of the thickest one; 0: there is none
  scene::Vector at = {};  ///< a place in it, m
};
struct SurveyedPassages : scene::Passages {
  UnseenWall unseen = {};
};
/// Of Domain::passages, which nothing but survey_walls() makes.
inline const UnseenWall& unseen_wall(const scene::Passages& passages) {
  return static_cast<const SurveyedPassages&>(passages).unseen;
}

/// Makes Domain::passages of a scene with shapes; `known`: that of the same lattice, or null.
void survey_walls(scene::Scene& scene, const std::shared_ptr<const scene::Passages>& known = {});

}  // namespace rouleau::shape
