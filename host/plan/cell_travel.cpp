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

CellTravel cell_travel(const scene::Scene& scene, const StageSetting& stage) {
  if (scene.fluid.inertia || scene.cells.empty() || scene.domain.periodic_y) return {};
  const double spacing = stage.units.length, height = scene.domain.nodes[1], viscosity = core::viscosity_of(stage.tau);
  double cell_radius = 0;
  for (const scene::CellPlacement& cell : scene.cells) {
    cell_radius = std::max(cell_radius, shape::shape_radius(scene.cell_types[cell.type].shape) / spacing);
  }
  CellTravel travel;
  const auto add = [&](double shear_rate, double body_force, const core::WallVelocity& walls) {
    double mean = 0, farthest = 0;
    std::vector<double> speeds;
    for (const scene::CellPlacement& cell : scene.cells) {
      const double y = cell.center.y() / spacing;
      if (scene.domain.tube_radius) {
        const double radius = *scene.domain.tube_radius / spacing;
        const double off = std::hypot(y - height / 2, (cell.z - scene.domain.depth->size / 2) / spacing);
        speeds.push_back(body_force * std::max(0.0, radius * radius - off * off) / (4 * viscosity));
      } else {
        speeds.push_back(shear_rate * (y - height / 2) + body_force * y * (height - y) / (2 * viscosity) +
                         (walls.lower + walls.upper) / 2);
      }
      mean += speeds.back() / static_cast<double>(scene.cells.size());
    }
    for (const double speed : speeds) farthest = std::max(farthest, std::abs(speed - mean));
    travel.mean += std::abs(mean) * cell_radius / viscosity;
    travel.spread += farthest * cell_radius / viscosity;
  };
  add(stage.shear_rate, stage.body_force_x, stage.walls);
  // At its largest, and without the delay by the fluid's inertia.
  if (stage.oscillation.any()) add(stage.oscillating_rate, stage.oscillation.body_force_x, stage.oscillation.walls);
  return travel;
}

bool follows_cells(const scene::Scene& scene, const StageSetting& stage) {
  if (scene.fluid.inertia || scene.cells.empty() || scene.domain.depth) return false;
  // Between no walls a driven fluid goes faster and faster, and cells with it.
  return scene.domain.periodic_y ? stage.is_driven() : cell_travel(scene, stage).mean > threshold;
}

}  // namespace rouleau::plan
