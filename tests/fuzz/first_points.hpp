// The scenes of a matrix, for targets that read one.
#pragma once

#include "target.hpp"
#include "trial/matrix.hpp"

namespace rouleau::fuzz {

/// Makes names, labels and scenes of the first points.
inline void make_first_points(const nlohmann::json& scene, const std::vector<trial::Axis>& axes) {
  int looked_at = 0;
  for (const auto& point : trial::cross(axes)) {
    if (++looked_at > 20) break;
    require_printable(trial::name_of(axes, point));
    trial::labels_of(axes, point).dump();
    trial::scene_of(scene, axes, point).dump();
  }
}

}  // namespace rouleau::fuzz
