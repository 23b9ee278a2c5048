#include "flow.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "constants.hpp"
#include "core/fluid/developed_flow.hpp"
#include "core/fluid/relaxation.hpp"
#include "scene/driving_flow.hpp"
#include "scene/lattice.hpp"
#include "shape/extent.hpp"

namespace rouleau::plan {

namespace {

constexpr double square_of_pi = std::numbers::pi * std::numbers::pi;
constexpr int modes = 60;  // of the first instants, when all of them are there

bool driven_alike(const scene::Stage& a, const scene::Stage& b) {
  return a.shear_rate == b.shear_rate && a.mean_wall_speed == b.mean_wall_speed && a.mean_velocity == b.mean_velocity &&
         a.pressure_gradient == b.pressure_gradient && !a.changes() && !b.changes();
}

}  // namespace

// Between walls that move the n-th mode has amplitude 2 (-1)^n and T/n^2, and delay = T pi^2/6; the flow rate of a
// channel has modes of amplitude 96/(pi n)^4 with odd n and T/n^2, and delay = T pi^2/10.
double FlowStart::decay() const { return delay * (driven ? 10 : 6) / square_of_pi; }

double FlowStart::rate_at(double strain) const {
  if (!(delay > 0)) return 1;
  if (!(strain > 0)) return 0;
  double rate = 1;
  for (int n = 1; n <= modes; n += driven ? 2 : 1) {
    const double left = std::exp(-n * n * strain / decay());
    if (left < 1e-17) break;
    rate += driven ? -96 / (square_of_pi * square_of_pi) / std::pow(n, 4) * left : (n % 2 == 0 ? 2 : -2) * left;
  }
  return std::clamp(rate, 0.0, 1.0);
}

double FlowStart::left_at(double strain) const {
  return delay > 0 ? std::min(1.0, (driven ? 1 : 2) * std::exp(-strain / decay())) : 0;
}

double FlowStart::left_of_viscosity(double strain) const {
  if (!(delay > 0)) return 0;
  const double part = strain / decay();
  return (driven ? 2 : 4) / part * std::exp(-part / 2);
}

FlowStart flow_start(const scene::Scene& scene, int index) {
  const scene::Stage& stage = scene.stages[index];
  if (index > 0 && driven_alike(stage, scene.stages[index - 1])) return {};
  // Of a fluid alone its true start counts, too.
  const double counted = scene.cells.empty() ? stage.density_factor : std::max(0.0, stage.density_factor - 1);
  return {counted * scene::start_up_strain(stage, scene), stage.shear_rate == 0};
}

double capsule_relaxation(double capillary_number, double viscosity_ratio) {
  return 0.566 * std::pow(capillary_number / 0.05, 0.4) * (viscosity_ratio + 1.68) / 2.68;
}

double capsule_left(const FlowStart& start, double relaxation, double strain) {
  if (!(start.delay > 0)) return 0;
  using Complex = std::complex<double>;
  // Of either z the exact solution over a short step with constant g.
  const double step = std::min({relaxation, start.delay, strain}) / 20;
  const long steps = std::min(100000L, static_cast<long>(std::ceil(strain / step)));
  const double h = strain / static_cast<double>(steps);
  const auto advanced = [&](Complex z, double g) {
    const Complex rate(1 / relaxation, -g), steady = g / relaxation / rate;
    return steady + (z - steady) * std::exp(-rate * h);
  };
  Complex late, developed;
  for (long i = 0; i < steps; ++i) {
    late = advanced(late, start.rate_at((static_cast<double>(i) + 0.5) * h));
    developed = advanced(developed, 1);
  }
  return std::abs(late - developed) / std::abs(developed);
}

CellTravel cell_travel(const scene::Scene& scene, const scene::StageSetting& stage) {
  if (scene.fluid.inertia || scene.cells.empty() || !scene::has_walls(scene.domain)) return {};
  const scene::Domain& domain = scene.domain;
  const int across = domain.walled(1) ? 1 : 2;
  const double spacing = stage.units.length, height = scene::wall_distance(domain) / spacing;
  const double viscosity = core::viscosity_of(stage.tau);
  double cell_radius = 0;
  for (const scene::CellPlacement& cell : scene.cells)
    cell_radius = std::max(cell_radius, shape::shape_radius(scene.cell_types[cell.type].shape) / spacing);
  CellTravel travel;
  const auto add = [&](double shear_rate, const scene::Vector& force, const core::WallVelocity& walls) {
    const scene::Vector drive = scene::unheld(force, domain);
    scene::Vector mean;
    double farthest = 0;
    std::vector<scene::Vector> velocities;
    for (const scene::CellPlacement& cell : scene.cells) {
      const double place = cell.center[across] / spacing;
      scene::Vector& velocity = velocities.emplace_back();
      if (domain.has_shapes()) {
        velocity = height * height / (8 * viscosity) * drive;  // at the widest place: no faster
      } else if (domain.tube_radius) {
        const double radius = *domain.tube_radius / spacing;
        scene::Vector off = cell.center - 0.5 * domain.size;
        off.x() = 0;
        velocity = std::max(0.0, radius * radius - std::pow(off.norm() / spacing, 2)) / (4 * viscosity) * drive;
      } else {
        velocity = place * (height - place) / (2 * viscosity) * drive;
        velocity.x() += shear_rate * (place - height / 2) + (walls.lower + walls.upper) / 2;
      }
      mean += 1 / static_cast<double>(scene.cells.size()) * velocity;
    }
    for (const scene::Vector& velocity : velocities) farthest = std::max(farthest, (velocity - mean).norm());
    travel.mean += mean.norm() * cell_radius / viscosity;
    travel.spread += farthest * cell_radius / viscosity;
  };
  add(stage.shear_rate, stage.body_force, stage.walls);
  // At its largest, and without the delay by the fluid's inertia.
  if (stage.oscillation.any())
    add(stage.oscillating_rate, {stage.oscillation.body_force_x, 0}, stage.oscillation.walls);
  return travel;
}

bool follows_cells(const scene::Scene& scene, const scene::StageSetting& stage) {
  if (scene.fluid.inertia || scene.cells.empty() || !frame_follows[scene.domain.dimension() - 2]) return false;
  if (scene.domain.has_shapes() || scene.domain.is_open()) return false;  // cells do not travel together
  // Between no walls a driven fluid goes faster and faster, and cells with it.
  return !scene.domain.walled(1) ? stage.is_driven() : cell_travel(scene, stage).mean > follows_from;
}

double fastest_driven_speed(const scene::StageSetting& stage, const scene::Scene& scene) {
  const double height = scene::wall_distance(scene.domain) / stage.units.length;
  const double viscosity = core::viscosity_of(scene.numerics.tau), drive = stage.largest_drive(scene.domain);
  if (scene.domain.tube_radius) return drive * height * height / (16 * viscosity);
  if (scene.fluid.layers.empty() || !scene.domain.walled(1)) return drive * height * height / (8 * viscosity);
  double fastest = 0;
  const std::vector<double> rows = core::viscosity_of_rows(scene::lattice_layers(scene), scene.domain.nodes[1]);
  for (const core::ProfilePoint& point : core::layered_profile(rows, viscosity, {}, drive))
    fastest = std::max(fastest, std::abs(point.velocity));
  return fastest;
}

double compression_by_held_force(const scene::StageSetting& stage, const scene::Scene& scene) {
  const scene::Vector held = stage.body_force - scene::unheld(stage.body_force, scene.domain);
  double pressure = 0;
  for (int axis = 0; axis < held.dimension(); ++axis) pressure += std::abs(held[axis]) * scene.domain.across(axis);
  return compression_by_pressure / 2 * pressure / stage.units.length;
}

}  // namespace rouleau::plan
