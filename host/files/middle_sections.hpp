// What pictures show of surfaces: the outline in which each is cut by the plane across z through its middle.
#pragma once

#include "observe/snapshot.hpp"

namespace rouleau::files {

/// For each surface a closed polygon of so many points, counter-clockwise, at equal lengths from the one farthest along
/// x on; of a cut in several pieces the longest one. Tensions are those at the places of the cut.
observe::OutlineSnapshot middle_sections(const observe::OutlineSnapshot& surfaces, int points = 128);

}  // namespace rouleau::files
