// Cells that overlap for certain, found by their centres before any of them is placed.
#pragma once

#include <optional>

#include "scene/scene.hpp"

namespace rouleau::shape {

struct CrowdedPair {
  int cell, other;  ///< indices into Scene::cells
  double distance;  ///< between their centres, or those of their images, m
};

/// Two cells whose centres are nearer than the circles around them that fit into the cells allow. Takes time and memory
/// for the centres alone, so that a million cells on top of each other are found at once.
std::optional<CrowdedPair> find_crowded_pair(const scene::Scene& scene);

}  // namespace rouleau::shape
