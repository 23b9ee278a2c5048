#include "driving_flow.hpp"

#include <cmath>
#include <numbers>

namespace rouleau::scene {

bool walls_move(const Stage& stage) {
  return stage.shear_rate != 0 || stage.mean_wall_speed != 0 || stage.oscillation.shear_rate != 0 ||
         stage.oscillation.mean_wall_speed != 0;
}

Eigen::Vector2d driving_force(const Stage& stage, const Scene& scene) {
  if (stage.mean_velocity) {
    const double height = scene.domain.size.y();
    return {12 * scene.fluid.viscosity * *stage.mean_velocity / (height * height), scene.fluid.body_force.y()};
  }
  return scene.fluid.body_force + stage.pressure_gradient;
}

namespace {

/// Of a steady flow.
double mean_rate(double shear_rate, double force, const Scene& scene) {
  if (shear_rate != 0) return std::abs(shear_rate);
  if (scene.domain.periodic_y) return 0;
  return std::abs(force) * scene.domain.size.y() / (4 * scene.fluid.viscosity);
}

double steady_rate(const Stage& stage, const Scene& scene) {
  return mean_rate(stage.shear_rate, driving_force(stage, scene).x(), scene);
}

}  // namespace

double mean_shear_rate(const Stage& stage, const Scene& scene) {
  const double steady = steady_rate(stage, scene);
  if (!stage.oscillates()) return steady;
  return steady + mean_rate(stage.oscillation.shear_rate, stage.oscillation.pressure_gradient, scene);
}

double start_up_strain(const Stage& stage, const Scene& scene) {
  if (stage.start == WallStart::developed || scene.domain.periodic_y) return 0;
  const double height = scene.domain.size.y(), nu = scene.fluid.viscosity / scene.fluid.density;
  return steady_rate(stage, scene) * height * height / nu / (stage.shear_rate != 0 ? 24 : 10);
}

double oscillation_delay(const Stage& stage, const Scene& scene) {
  if (!stage.oscillates() || scene.domain.periodic_y) return 0;
  const double half = scene.domain.size.y() / 2, nu = scene.fluid.viscosity / scene.fluid.density;
  const double womersley_square = 2 * std::numbers::pi * stage.oscillation.frequency * half * half / nu;
  if (stage.oscillation.mean_wall_speed != 0) return womersley_square / 2;
  return womersley_square * (stage.oscillation.shear_rate != 0 ? 1.0 / 6 : 0.4);
}

}  // namespace rouleau::scene
