// Walls that are no planes, as the page holds them.
#pragma once

#include "files/frames.hpp"
#include "json/json.hpp"

namespace rouleau::report {

/// {corners_um, first, segments, surface}: x and y of the corners of polygons around walls, one after another, polygon
/// i from corner first[i] on; segments: pairs of corners between which fluid meets them; surface {quantum_um, points,
/// triangles} in three dimensions, else null: base64 of 16-bit multiples of the quantum, x, y, z of every corner, and
/// of 32-bit numbers of corners. Null without such walls.
nlohmann::json wall_data(const files::FrameReader& reader);

}  // namespace rouleau::report
