#include "cell_travel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/fluid/relaxation.hpp"
#include "shape/outline.hpp"

namespace rouleau::plan {

namespace {

constexpr double threshold = 0.002;

}  // namespace

CellTravel cell_travel(const scene::Scene& scene, const scene::StageSetting& stage) {
  if (scene.fluid.inertia || scene.cells.empty() || !scene::has_walls(scene.domain)) return {};
  const bool across_z = scene.domain.periodic_y;
  const double spacing = stage.units.length, height = scene::wall_distance(scene.domain) / spacing;
  const double viscosity = core::viscosity_of(stage.tau);
  double cell_radius = 0;
  for (const scene::CellPlacement& cell : scene.cells) {
    cell_radius = std::max(cell_radius, shape::shape_radius(scene.cell_types[cell.type].shape) / spacing);
  }
  CellTravel travel;
  const auto add = [&](double shear_rate, const Eigen::Vector3d& force, const core::WallVelocity& walls) {
    const Eigen::Vector3d drive = scene::unheld(force, scene.domain);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double farthest = 0;
    std::vector<Eigen::Vector3d> velocities;
    for (const scene::CellPlacement& cell : scene.cells) {
      const double place = (across_z ? cell.z : cell.center.y()) / spacing;
      Eigen::Vector3d& velocity = velocities.emplace_back();
      if (scene.domain.tube_radius) {
        const double radius = *scene.domain.tube_radius / spacing;
        const double off =
            std::hypot(cell.center.y() - scene.domain.size.y() / 2, cell.z - scene.domain.depth->size / 2) / spacing;
        velocity = drive * (std::max(0.0, radius * radius - off * off) / (4 * viscosity));
      } else {
        velocity = drive * (place * (height - place) / (2 * viscosity));
        velocity.x() += shear_rate * (place - height / 2) + (walls.lower + walls.upper) / 2;
      }
      mean += velocity / static_cast<double>(scene.cells.size());
    }
    for (const Eigen::Vector3d& velocity : velocities) farthest = std::max(farthest, (velocity - mean).norm());
    travel.mean += mean.norm() * cell_radius / viscosity;
    travel.spread += farthest * cell_radius / viscosity;
  };
  add(stage.shear_rate, {stage.body_force_x, stage.body_force_y, stage.body_force_z}, stage.walls);
  // At its largest, and without the delay by the fluid's inertia.
  if (stage.oscillation.any())
    add(stage.oscillating_rate, {stage.oscillation.body_force_x, 0, 0}, stage.oscillation.walls);
  return travel;
}

bool follows_cells(const scene::Scene& scene, const scene::StageSetting& stage) {
  if (scene.fluid.inertia || scene.cells.empty() || scene.domain.depth) return false;
  // Between no walls a driven fluid goes faster and faster, and cells with it.
  return scene.domain.periodic_y ? stage.is_driven() : cell_travel(scene, stage).mean > threshold;
}

}  // namespace rouleau::plan
