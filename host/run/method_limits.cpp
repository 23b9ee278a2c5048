// Limits of the method for a scene, measured with explicit coupling and the 4-point kernel (docs/stability.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cell_report.hpp"
#include "method_limits.hpp"
#include "plan.hpp"

namespace rouleau::host {

namespace {

struct TableEntry {
  double tau, value;
};

/// Value at tau, linear in log tau' with tau' = tau - 1/2, constant beyond the ends of the table.
template <std::size_t n>
double interpolate(const std::array<TableEntry, n>& table, double tau) {
  if (tau <= table.front().tau) return table.front().value;
  for (std::size_t i = 1; i < n; ++i) {
    if (tau > table[i].tau) continue;
    const double t =
        std::log((tau - 0.5) / (table[i - 1].tau - 0.5)) / std::log((table[i].tau - 0.5) / (table[i - 1].tau - 0.5));
    return std::exp((1 - t) * std::log(table[i - 1].value) + t * std::log(table[i].value));
  }
  return table.back().value;
}

// Largest stiffness d tension / d stretch, d moment / d curvature and d force / d distance at which one cell at rest
// stayed quiet. The first is three times the largest shear modulus of a neo-Hookean membrane.
constexpr std::array<TableEntry, 6> stretch_limit{
    {{0.505, 0.18}, {0.55, 1.7}, {0.6, 2.3}, {1.0, 6.3}, {2.0, 5.1}, {10.0, 2.1}}};
constexpr std::array<TableEntry, 5> bending_limit{{{0.55, 0.36}, {0.6, 0.86}, {1.0, 6.8}, {2.0, 3.8}, {5.0, 1.7}}};
constexpr std::array<TableEntry, 3> contact_limit{{{0.6, 0.65}, {1.0, 1.46}, {2.0, 0.97}}};

/// Largest value of a derivative over the given inputs.
double largest(const std::vector<double>& values) {
  double most = 0;
  for (double v : values) most = std::max(most, std::abs(v));
  return most;
}

double stretch_stiffness(const ModelInstance& law) {
  const std::vector<double> stretch{0.95, 1.0, 1.1};
  std::vector<double> stiffness(stretch.size(), 0.0);
  rouleau_membrane_block block{};
  block.struct_size = sizeof block;
  block.count = static_cast<std::uint32_t>(stretch.size());
  block.time_step = 1;
  const std::vector<double> zero(stretch.size(), 0.0);
  block.stretch = stretch.data();
  if (law.manifest().needs_input("stretch_rate")) block.stretch_rate = zero.data();
  block.tension_by_stretch = stiffness.data();
  law.membrane().compute(law.self(), &block);
  return largest(stiffness);
}

double bending_stiffness(const ModelInstance& law) {
  const double curvature = 0, rest = 0;
  double stiffness = 0;
  rouleau_membrane_block block{};
  block.struct_size = sizeof block;
  block.count = 1;
  block.time_step = 1;
  block.curvature = &curvature;
  if (law.manifest().needs_input("rest_curvature")) block.rest_curvature = &rest;
  block.moment_by_curvature = &stiffness;
  law.membrane().compute(law.self(), &block);
  return stiffness;
}

/// Largest stiffness of a potential in its attractive part, where membranes settle: at and beyond its zero of force.
double contact_stiffness(const ModelInstance& potential, double& zero_force_distance) {
  const double cutoff = potential.interaction().cutoff(potential.self());
  constexpr int samples = 400;
  std::vector<double> distance, force(samples), stiffness(samples);
  for (int i = 1; i <= samples; ++i) distance.push_back(cutoff * i / samples);
  rouleau_interaction_block block{};
  block.struct_size = sizeof block;
  block.count = samples;
  block.time_step = 1;
  block.distance = distance.data();
  block.force = force.data();
  block.force_by_distance = stiffness.data();
  potential.interaction().compute(potential.self(), &block);
  zero_force_distance = std::nan("");
  double most = 0;
  for (int i = samples - 1; i >= 0; --i) {
    const auto k = static_cast<std::size_t>(i);
    if (force[k] > 0) {
      zero_force_distance = k + 1 < distance.size() ? distance[k + 1] : distance[k];
      most = std::max(most, std::abs(stiffness[k]));
      break;
    }
    most = std::max(most, std::abs(stiffness[k]));
  }
  return most;
}

}  // namespace

std::vector<Limit> find_limits(const Plan& plan) {
  const Scene& scene = *plan.scene;
  std::vector<Limit> limits;
  // `upper`: the value must stay below the limit; otherwise above it.
  const auto add = [&](const std::string& name, double value, double limit, bool upper, const std::string& remedy) {
    if (!std::isfinite(value)) return;
    const double margin = upper ? (value > 0 ? limit / value : std::numeric_limits<double>::infinity()) : value / limit;
    limits.push_back({name, value, limit, margin, remedy});
  };
  const double tau = scene.numerics.tau;
  add("tau - 1/2", tau - 0.5, 0.005, false, "raise numerics.tau above 0.505");

  for (const StageSetting& stage : plan.stages) {
    const std::string where = " (stage " + stage.stage->name + ")";
    const ModelSetting setting = stage.model_setting(scene.fluid.inertia);
    // Also opens the library, so that a plan never promises a run that cannot start.
    const ModelInstance collision(*plan.collision.manifest, plan.collision.parameters.values, setting);
    if (stage.wall_speed != 0) {
      add("Mach number of the walls" + where, std::abs(stage.wall_speed) * std::sqrt(3.0), 0.1, true,
          "lower density_factor or shear_rate, or raise the resolution");
    }
    if (stage.body_force_x != 0 && !scene.domain.periodic_y) {
      const double height = scene.domain.nodes[1];
      const double speed = std::abs(stage.body_force_x) * height * height / (8 * (tau - 0.5) / 3);
      add("Mach number of the driven flow" + where, speed * std::sqrt(3.0), 0.1, true,
          "lower density_factor or the driving force, or raise the resolution");
    }
    if (!plan.has_cells) continue;
    if (stage.body_force_x != 0 && !scene.domain.periodic_y && !scene.fluid.inertia) {
      // Without u.grad u the unsteady term is not the same for a fluid that moves as a whole: a cell that travels with
      // it leaves a wake and migrates wrongly, in proportion to this number (docs/rheology.md).
      const double height = scene.domain.nodes[1], viscosity = (tau - 0.5) / 3;
      const double speed = std::abs(stage.body_force_x) * height * height / (12 * viscosity);
      double radius = 0;
      for (const CellPlacement& cell : scene.cells) {
        radius = std::max(radius, shape_radius(scene.cell_types[static_cast<std::size_t>(cell.type)].shape));
      }
      add("Reynolds number of cells that travel, without convective inertia" + where,
          speed * radius / stage.units.length / viscosity, 0.05, true,
          "set fluid.inertia to true, or lower density_factor: cells would migrate across the channel wrongly");
    }
    double stretching = 0, bending = 0, radius = 1e300, shortest = 1e300, longest = 0;
    for (const std::vector<PlannedModel>& laws : plan.membranes) {
      double type_stretching = 0, type_bending = 0;
      for (const PlannedModel& law : laws) {
        if (!law.active()) continue;
        const ModelInstance instance(*law.manifest, law.parameters.values, setting);
        if (law.manifest->gives_output("tension_by_stretch")) type_stretching += stretch_stiffness(instance);
        if (law.manifest->gives_output("moment_by_curvature")) type_bending += bending_stiffness(instance);
      }
      stretching = std::max(stretching, type_stretching);
      bending = std::max(bending, type_bending);
    }
    add("stretching stiffness in lattice units" + where, stretching, interpolate(stretch_limit, tau), true,
        "lower density_factor, with which the lattice stiffness falls");
    add("bending stiffness in lattice units" + where, bending, interpolate(bending_limit, tau), true,
        "lower density_factor, with which the lattice stiffness falls");
    for (const PlannedModel& model : plan.interactions) {
      if (!model.active()) continue;
      const ModelInstance instance(*model.manifest, model.parameters.values, setting);
      double zero_force = 0;
      const double stiffness = contact_stiffness(instance, zero_force);
      add("contact stiffness of " + model.manifest->id + " in lattice units" + where, stiffness,
          interpolate(contact_limit, tau), true, "lower density_factor, with which the lattice stiffness falls");
      if (stage.index == 0) {
        add("equilibrium gap of " + model.manifest->id + " in lattice spacings", zero_force, 2.0, false,
            "raise the resolution, for membranes whose gap it does not resolve stick for ever");
      }
    }
    if (stage.index != 0) continue;
    for (const CellPlacement& cell : scene.cells) {
      const CellType& type = scene.cell_types[static_cast<std::size_t>(cell.type)];
      double r, perimeter;
      if (const auto* b = std::get_if<Biconcave>(&type.shape)) {
        r = b->radius;
        perimeter = 4.9285 * b->radius;
      } else if (const auto* c = std::get_if<Circle>(&type.shape)) {
        r = c->radius;
        perimeter = 2 * std::numbers::pi * r;
      } else {
        const auto& e = std::get<Ellipse>(type.shape);
        r = e.semi_axes.maxCoeff();
        perimeter = std::numbers::pi * (3 * e.semi_axes.sum() - std::sqrt((3 * e.semi_axes.x() + e.semi_axes.y()) *
                                                                          (e.semi_axes.x() + 3 * e.semi_axes.y())));
      }
      radius = std::min(radius, r / stage.units.length);
      const double segment = perimeter / type.segments / stage.units.length;
      shortest = std::min(shortest, segment);
      longest = std::max(longest, segment);
    }
    add("cell radius in lattice spacings", radius, 10, false,
        "raise the resolution; results are converged from about 20");
    add("shortest segment in lattice spacings", shortest, 0.4, false,
        "take fewer segments; about one for each spacing is best");
    add("longest segment in lattice spacings", longest, longest_segment, true,
        "take more segments, for fluid leaks between nodes that lie far apart; about one for each spacing is best");
  }
  std::stable_sort(limits.begin(), limits.end(), [](const Limit& a, const Limit& b) { return a.margin < b.margin; });
  return limits;
}

}  // namespace rouleau::host
