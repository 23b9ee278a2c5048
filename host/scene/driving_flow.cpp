#include "driving_flow.hpp"

#include <cmath>

namespace rouleau::scene {

Eigen::Vector2d driving_force(const Stage& stage, const Scene& scene) {
  return scene.fluid.body_force + stage.pressure_gradient;
}

double mean_shear_rate(const Stage& stage, const Scene& scene) {
  if (stage.shear_rate != 0) return std::abs(stage.shear_rate);
  if (scene.domain.periodic_y) return 0;
  return std::abs(driving_force(stage, scene).x()) * scene.domain.size.y() / (4 * scene.fluid.viscosity);
}

}  // namespace rouleau::scene
