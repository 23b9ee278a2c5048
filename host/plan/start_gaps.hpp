// How near cells lie to each other and to walls where a scene places them.
#pragma once

#include <limits>

#include "scene/scene.hpp"

namespace rouleau::plan {

/// Smallest gaps at the start, lattice spacings; infinite where nothing is near.
struct StartGaps {
  double cells = std::numeric_limits<double>::infinity();  ///< between two cells, images included
  double walls = cells;                                    ///< to plane walls
  double tube = cells;                                     ///< to the wall of a tube, however far
};
/// Of cells that are nearer than two spacings. Cells at random, which need not have been placed, count with the gap
/// that they keep, in a tube always, else where it is below the least one. Of more than 20 000 others gaps are not
/// looked for: the file that has them is taken as it is.
StartGaps start_gaps(const scene::Scene& scene);

}  // namespace rouleau::plan
