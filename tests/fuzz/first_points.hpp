// The scenes of a matrix, for targets that read one.
#pragma once

#include "study/matrix.hpp"
#include "target.hpp"

namespace rouleau::fuzz {

/// Makes names, labels and scenes of the first points.
inline void make_first_points(const nlohmann::json& scene, const std::vector<host::Axis>& axes) {
  int looked_at = 0;
  for (const auto& point : host::cross(axes)) {
    if (++looked_at > 20) break;
    require_printable(host::name_of(axes, point));
    host::labels_of(axes, point).dump();
    host::scene_of(scene, axes, point).dump();
  }
}

}  // namespace rouleau::fuzz
