#include "driving_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rouleau::scene {

bool walls_move(const Stage& stage) {
  return stage.shear_rate != 0 || stage.mean_wall_speed != 0 || stage.oscillation.shear_rate != 0 ||
         stage.oscillation.mean_wall_speed != 0;
}

// With a stress S - G y and fluidity 1/mu, both walls at rest give S = G B/A, and the flow rate is G (C - B^2/A), where
// A, B and C are the integrals of 1/mu, y/mu and y^2/mu over the height.
double channel_viscosity(const Scene& scene) {
  if (scene.fluid.layers.empty()) return scene.fluid.viscosity;
  const double height = scene.domain.size.y();
  double a = 0, b = 0, c = 0;
  const auto add = [&](double from, double to, double fluidity) {
    a += fluidity * (to - from) / height;
    b += fluidity * (to * to - from * from) / (2 * height * height);
    c += fluidity * (to * to * to - from * from * from) / (3 * height * height * height);
  };
  add(0, height, 1 / scene.fluid.viscosity);
  for (const FluidLayer& layer : scene.fluid.layers)
    add(layer.from, layer.to, 1 / layer.viscosity - 1 / scene.fluid.viscosity);
  return 1 / (12 * (c - b * b / a));
}

double duct_share(const Domain& domain) {
  if (domain.has_shapes()) return std::nan("");
  if (!domain.is_duct()) return 1;
  const double pi = std::numbers::pi, height = domain.size.y(), width = domain.size.z();
  if (domain.tube_radius)  // Hagen and Poiseuille: pi G R^4 / (8 mu)
    return 1.5 * pi * std::pow(*domain.tube_radius, 4) / (width * std::pow(height, 3));
  // White, Viscous Fluid Flow, section 3-3; terms fall as 1/n^5.
  double sum = 0;
  for (int n = 199; n > 0; n -= 2) sum += std::tanh(n * pi * width / (2 * height)) / std::pow(n, 5);
  return 1 - 192 * height / (std::pow(pi, 5) * width) * sum;
}

ViscosityRange viscosity_range(const FluidProperties& fluid) {
  ViscosityRange range{fluid.viscosity, fluid.viscosity};
  for (const FluidLayer& layer : fluid.layers)
    range = {std::min(range.least, layer.viscosity), std::max(range.most, layer.viscosity)};
  return range;
}

double opening_drive(const Scene& scene) {
  const Domain& domain = scene.domain;
  if (!domain.openings || !has_walls(domain)) return 0;
  const auto& [inlet, outlet] = *domain.openings;
  if (inlet.pressure) return (*inlet.pressure - *outlet.pressure) / domain.size[domain.open_axis];
  // Of a developed flow, the largest velocity over the mean one: no more in any usual section.
  const bool in_plane_flow = domain.in_plane() || (!domain.has_shapes() && !(domain.is_duct() && domain.walled(1)));
  const double peak = domain.tube_radius ? 2 : in_plane_flow ? 1.5 : 2.25;
  const double narrower =
      domain.passages && domain.passages->least_open > 0 ? domain.passages->open[0] / domain.passages->least_open : 1;
  const double height = wall_distance(domain), round = domain.tube_radius ? 2 : 1;
  return 8 * round * scene.fluid.viscosity * peak * narrower * *inlet.mean_velocity / (height * height);
}

Vector driving_force(const Stage& stage, const Scene& scene) {
  Vector force = Vector::filled(scene.domain.dimension(), 0) + scene.fluid.body_force + stage.pressure_gradient;
  if (stage.mean_velocity && scene.domain.tube_radius) {
    const double radius = *scene.domain.tube_radius;
    force.x() = 8 * scene.fluid.viscosity * *stage.mean_velocity / (radius * radius);
  } else if (stage.mean_velocity) {
    const double height = scene.domain.across(1), share = scene.domain.has_shapes() ? 1 : duct_share(scene.domain);
    force.x() = 12 * channel_viscosity(scene) * *stage.mean_velocity / (height * height * share);
  }
  force[scene.domain.flow_axis()] += opening_drive(scene);
  return force;
}

bool has_walls(const Domain& domain) { return domain.walled(1) || domain.is_duct() || domain.has_shapes(); }

double wall_distance(const Domain& domain) { return domain.across(!domain.walled(1) && domain.is_duct() ? 2 : 1); }

Vector unheld(Vector force, const Domain& domain) {
  for (int axis = 1; axis < 3; ++axis)  // an opening holds nothing
    if (domain.walled(axis)) force[axis] = 0;
  return force;
}

double driving_part(const Vector& force, const Domain& domain) { return unheld(force, domain).norm(); }

namespace {

/// Of a steady flow.
double mean_rate(double shear_rate, const Vector& force, const Scene& scene) {
  if (shear_rate != 0) return std::abs(shear_rate);
  if (!has_walls(scene.domain)) return 0;
  const double height = wall_distance(scene.domain), round = scene.domain.tube_radius ? 2 : 1;
  return driving_part(force, scene.domain) * height / (4 * round * channel_viscosity(scene)) +
         scene.domain.shape_speed / height;
}

double steady_rate(const Stage& stage, const Scene& scene) {
  return mean_rate(stage.shear_rate, driving_force(stage, scene), scene);
}

}  // namespace

double mean_shear_rate(const Stage& stage, const Scene& scene) {
  const double steady = steady_rate(stage, scene);
  if (!stage.changes()) return steady;
  return steady + mean_rate(stage.oscillation.shear_rate, {stage.oscillation.pressure_gradient, 0}, scene);
}

bool knows_developed_flow(const Stage& stage, const Scene& scene) {
  if (scene.domain.has_shapes() || scene.domain.is_open()) return false;
  return !scene.domain.is_duct() || (!stage.changes() && scene.fluid.layers.empty());
}

bool knows_developed_flows(const Scene& scene) {
  return std::all_of(scene.stages.begin(), scene.stages.end(),
                     [&](const Stage& stage) { return knows_developed_flow(stage, scene); });
}

double start_up_strain(const Stage& stage, const Scene& scene) {
  if (stage.start == WallStart::developed || !has_walls(scene.domain)) return 0;
  const double height = wall_distance(scene.domain), nu = viscosity_range(scene.fluid).least / scene.fluid.density;
  const double slower = stage.shear_rate != 0 || scene.domain.tube_radius ? 24 : 10;
  return steady_rate(stage, scene) * height * height / nu / slower;
}

double oscillation_delay(const Stage& stage, const Scene& scene) {
  if (!stage.oscillates() || !has_walls(scene.domain)) return 0;
  const double half = wall_distance(scene.domain) / 2, nu = viscosity_range(scene.fluid).least / scene.fluid.density;
  const double womersley_square = 2 * std::numbers::pi * stage.oscillation.frequency * half * half / nu;
  if (stage.oscillation.mean_wall_speed != 0) return womersley_square / 2;
  return womersley_square * (stage.oscillation.shear_rate != 0 || scene.domain.tube_radius ? 1.0 / 6 : 0.4);
}

}  // namespace rouleau::scene
