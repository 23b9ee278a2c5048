#include "driving_flow.hpp"

#include <cmath>

namespace rouleau::scene {

bool walls_move(const Stage& stage) { return stage.shear_rate != 0 || stage.mean_wall_speed != 0; }

Eigen::Vector2d driving_force(const Stage& stage, const Scene& scene) {
  return scene.fluid.body_force + stage.pressure_gradient;
}

double mean_shear_rate(const Stage& stage, const Scene& scene) {
  if (stage.shear_rate != 0) return std::abs(stage.shear_rate);
  if (scene.domain.periodic_y) return 0;
  return std::abs(driving_force(stage, scene).x()) * scene.domain.size.y() / (4 * scene.fluid.viscosity);
}

double start_up_strain(const Stage& stage, const Scene& scene) {
  if (stage.start == WallStart::developed || scene.domain.periodic_y) return 0;
  const double height = scene.domain.size.y(), nu = scene.fluid.viscosity / scene.fluid.density;
  return mean_shear_rate(stage, scene) * height * height / nu / (stage.shear_rate != 0 ? 24 : 10);
}

}  // namespace rouleau::scene
