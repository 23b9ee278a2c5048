#include "stability_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "base/text.hpp"
#include "cell_travel.hpp"
#include "core/coupling/slip_constants.hpp"
#include "core/fluid/relaxation.hpp"
#include "core/membrane/node_mobility.hpp"
#include "core/membrane/semi_implicit_filter.hpp"
#include "core/membrane/stiffness.hpp"
#include "core/surface/surface_filter.hpp"
#include "error_model.hpp"
#include "flow_start.hpp"
#include "plan.hpp"
#include "plugin/handles.hpp"
#include "potential_shape.hpp"
#include "scene/driving_flow.hpp"
#include "shape/extent.hpp"
#include "shape/outline.hpp"
#include "solver_setup.hpp"
#include "start_gaps.hpp"

namespace rouleau::plan {

namespace {

// Measured with the 4-point kernel (docs/accuracy.md).

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

// It holds for a wall, too, where one side alone gives way: of stiff rings (1.16 in shear modulus, tau 1) in a well half a
// spacing wide, one at a wall stayed quiet at 0.74 and 1.48 and not at 2.96; two at each other at none of these. Two
// red cells in such a well came to rest, after strain 1 and without, with 0.7 of the stretching limit and 0.7 of this one, and
// with 0.3 and 0.9: the shares need not add up to less than one.

// In three dimensions shear keeps a cell's shape as well: two red cells came to rest at 255 (6e-6 J/m2), faces apart,
// and none was seen to touch itself. Beyond that nothing is known.
constexpr double deepest_well_of_bare_surfaces = 250;

// Times radius^2 in spacings, at viscosity ratio 5: a cell in shear 0.05 to 0.1 (4 to 14 spacings), in a tube 0.1 (10), 22 cells at
// 25 % 0.3 to 0.5 (10). At ratio 1 a cell leaks 0.11, at 0.02 0.4.
constexpr double leak_of_one = 0.1, leak_of_many = 0.5;

// Narrowest well, in spacings. Cells at rest settle even in wells of a twelfth of a spacing; but where segments are one
// spacing long, their corners catch on each other in a narrower one: sliding along a rim of 5 spacings radius meets 2 %
// of the strongest attraction at a width of 0.66, 5 % at 0.33, 11 % at 0.16 (docs/models.md).
constexpr double narrowest_well = 0.5;
constexpr double least_gap = 2;
// A wall has no corners: what the same rim meets when it rolls along one is 0.006 % of the strongest attraction at a
// width of 0.5, 0.8 % at 0.25 and 3.6 % at 0.17 (unit_contact, "a polygon rolls along a wall").
constexpr double narrowest_well_of_a_wall = 0.25;

// Of a layer of large viscosity: up to here steady flows along layers were found exact (tests/physics/layers.cpp).
constexpr double most_layered_tau = 50.5;

// Of a flow that oscillates: with less the velocity is more than 1 % of its amplitude off (tests/physics/oscillation.cpp).
constexpr double fewest_steps_of_period(double tau) { return 350 * (tau - 0.5) * (tau - 0.5); }
constexpr double thinnest_layer = 2.5;

// Of tau - 1/2 inside cells, with the slip correction or sharp6. Two sheared cells came apart at 0.016 and bore 0.018 (sharp6 and
// slip correction in three dimensions, limits/viscosity-ratio-3d.json); at 0.021 and 0.025 (slip correction in two,
// limits/viscosity-ratio.json). The plain scheme bore 0.005 in both.
constexpr double least_inside_corrected = 0.025;

/// Of a tube, in spacings: below it the lattice may cost more than 1 % of the flow rate, 0.65 / R^2 (tests/physics/tube.cpp).
constexpr double least_tube_radius = 8;

/// To the wall of a tube, beyond which velocities are read as 0: in spacings times the shear rate, membranes then move too
/// fast by at most 0.006 at 1.5, 0.04 at 1, 0.13 at 0.5 and 0.32 on the wall (sums of peskin4's weights, wherever nodes are).
constexpr double least_gap_to_tube = 1;

// Of a flow that starts at rest, where no target says otherwise: that share of a strain or of a value (docs/accuracy.md). Beyond
// the capillary number relaxations were not measured.
constexpr double largest_error_by_start = 0.01, largest_measured_capillary = 0.2;
// Of the strain of a stage: from 1 % on the plan, the run and its summary say by how much everything is late (LateStart).
constexpr double largest_share_of_strain = 0.1;

// How many times stiffer membranes may be with the semi-implicit step, for tau from 0.6 to 5; below it gains nothing. A
// single cell stays quiet at 80 times the stretching and 13 times the bending stiffness (docs/accuracy.md), two cells
// that are sheared and come to rest in contact at 20 times the former. There are two exceptions: with the slip
// correction and tau below 0.9 two cells bear 5 but not 10 times, for the slip of so stiff a membrane varies faster
// than the correction can follow; at tau 10 a cell with segments of two spacings bears 4 times. In three dimensions one
// cell bears 400 and 90 times, two cells in contact 24 times the stretching stiffness at tau 1, but 10 and not 13 times at tau 0.6
// (docs/stability.md).
constexpr double stretching_gain = 20, cautious_stretching_gain = 4, least_tau_of_full_gain = 0.9, most_tau = 5;
// Of two viscosities with the slip correction and the sharp kernel in three dimensions: a neo-Hookean sphere of ratio 5 came apart at
// 9 times the explicit limit at tau 4, not at 17 times at tau 3.
constexpr double most_tau_of_sharp_contrast = 3;
constexpr double bending_gain = 10, least_semi_implicit_tau = 0.6;
// Forces that the step holds stay with the nodes and turn with the membrane. Capsules of all stiffnesses, viscosity ratios and kernels
// bore a strain of 0.186 while the mean of forces lasts; the stiffest did not bear 0.2 (docs/stability.md).
constexpr double largest_held_strain = 0.15;
// What turns over does so too late, at viscosity ratio 5 too early, by half of the variance over which its slip is smoothed, for
// 0.02 to 0.2 of the radius squared (docs/accuracy.md, "Stiff membranes").
constexpr double largest_slip_smoothing = 0.04;
// The companions of auto's error bars have spacings up to 1.8 times as long, on which forces are held over the third power of that.
constexpr double held_on_companions = 6;
// The waves of two segments that the sharp kernels let grow are as slow as before; two cells bear 0.56 times the explicit
// stiffness with roma3.
constexpr double semi_implicit_loss = 0.5, nowhere = std::numeric_limits<double>::infinity();

constexpr std::array<KernelFacts, 5> kernels{{
    {core::KernelKind::peskin4, "peskin4", 0, 1, 1, least_semi_implicit_tau, ""},
    {core::KernelKind::cosine4, "cosine4", 0.0211, 1, 1, least_semi_implicit_tau,
     "its first moment reaches 0.021 spacings: with bending and segments shorter than a spacing it puts a false torque "
     "into the fluid (11 degrees off at strain 1 for a biconcave cell of half a spacing per segment); take peskin4"},
    {core::KernelKind::roma3, "roma3", 0, 0.095, 0.057, nowhere,
     "it lets ten times less stiffness pass than peskin4 before nodes zigzag, which the semi-implicit step does not "
     "change, and leaks twice the area"},
    {core::KernelKind::linear2, "linear2", 0, 0.013, 0.0066, nowhere,
     "it lets seventy times less stiffness pass than peskin4, and cells leak silently beyond that limit; it is here for "
     "comparison"},
    {core::KernelKind::sharp6, "sharp6", 0, 0.36, 0.22, 0.9, ""},
}};

/// Relaxation time of a fluid with this viscosity, Pa s.
double relaxation_time_of(double viscosity, const scene::Scene& scene) {
  return core::relaxation_time_of(viscosity / scene.fluid.viscosity * core::viscosity_of(scene.numerics.tau));
}

/// Limit of a membrane between two fluids: the geometric mean of those at either side's relaxation time. Measured at
/// tau 1 and ratio 5: 0.83 and 0.63 of the limits at ratio 1, by this rule 0.83 and 0.63. A cell may come into every
/// layer, so that the lowest counts.
template <std::size_t n>
double limit_between(const std::array<TableEntry, n>& table, const scene::Scene& scene, double interior_viscosity) {
  double outside = interpolate(table, scene.numerics.tau);
  for (const scene::FluidLayer& layer : scene.fluid.layers)
    outside = std::min(outside, interpolate(table, relaxation_time_of(layer.viscosity, scene)));
  return std::sqrt(outside * interpolate(table, relaxation_time_of(interior_viscosity, scene)));
}

/// A stiffness as the fluid feels it, and its limit with explicit coupling.
struct Bounded {
  double value = 0, limit = 1;
  [[nodiscard]] double margin() const { return limit / value; }
  /// Becomes the other, unless that is further from its limit.
  void narrow(const Bounded& other) {
    if (!(margin() < other.margin())) *this = other;
  }
};
struct Stiffness {
  Bounded stretching, bending;
  double steps_of_mean = 0;  ///< over which a semi-implicit step holds forces; in three dimensions
  /// Variance over which slip is spread along a membrane, over the radius squared; in two dimensions, of cells that are not
  /// round. By the stretching stiffness alone; the bending of a red cell would add less than 2 %.
  double slip_smoothing = 0;
};

/// Of all cell types in a stage, the stretching and the bending stiffness that are nearest to their limits, and the longest mean.
Stiffness membrane_stiffness(const Plan& plan, const plugin::ModelSetting& setting) {
  const scene::Scene& scene = *plan.scene;
  const KernelFacts& kernel = kernel_named(scene.numerics.kernel);
  Stiffness nearest;
  for (std::size_t t = 0; t < plan.membranes.size(); ++t) {
    const scene::CellType& cell = scene.cell_types[t];
    const double ratio = cell.interior_viscosity / scene.fluid.viscosity;
    const double length = shape::node_spacing(cell) / setting.units.length;
    core::SlipConstants slip{0, 0};
    if (scene.numerics.slip_correction) slip = core::slip_constants(kernel.kind, ratio, scene.domain.dimension());
    const double factor = core::stiffening(slip.shift, length), viscosity = core::viscosity_of(scene.numerics.tau);
    core::Stiffness stiffness;
    for (const PlannedModel& law : plan.membranes[t]) {
      if (law.active()) stiffness += plugin::make_membrane_law(*law.manifest, law.parameters.values, setting);
    }
    nearest.stretching.narrow({factor * stiffness.stretching,
                               kernel.stretch_limit * limit_between(stretch_limit, scene, cell.interior_viscosity)});
    nearest.bending.narrow({factor * stiffness.bending,
                            kernel.bending_limit * limit_between(bending_limit, scene, cell.interior_viscosity)});
    if (scene.domain.depth) {
      const double eigenvalue = core::largest_eigenvalue(core::kernel_response(kernel.kind, slip.shift),
                                                         stiffness.stretching, stiffness.bending);
      nearest.steps_of_mean = std::max(nearest.steps_of_mean, core::steps_of_mean(eigenvalue, viscosity));
    } else if (scene.numerics.slip_correction && !std::holds_alternative<scene::Circle>(cell.shape)) {
      const double over_radius = length * setting.units.length / shape::shape_radius(cell.shape);
      nearest.slip_smoothing =
          std::max(nearest.slip_smoothing,
                   over_radius * over_radius / 2 *
                       core::outline_slip_smoothings(length, slip.slip / viscosity, stiffness.stretching));
    }
  }
  return nearest;
}

/// Relative change of the area of a cell whose membrane is stretched from the start: the tension T over the radius a is
/// a pressure (twice that of a sphere), and density deviates by three times the pressure. 0 without prestretch.
double prestress_compression(const Plan& plan, const scene::StageSetting& stage) {
  double most = 0;
  for (std::size_t type = 0; type < plan.membranes.size(); ++type) {
    const scene::Shape& shape = plan.scene->cell_types[type].shape;
    const auto* circle = std::get_if<scene::Circle>(&shape);
    const auto* sphere = std::get_if<scene::Sphere>(&shape);
    if (circle == nullptr && sphere == nullptr) continue;
    const double radius = circle != nullptr ? circle->radius : sphere->radius;
    const double prestretch = circle != nullptr ? circle->prestretch : sphere->prestretch;
    double tension = 0;
    for (const PlannedModel& law : plan.membranes[type]) {
      if (!law.active()) continue;
      const core::MembraneLaw instance = plugin::make_membrane_law(*law.manifest, law.parameters.values,
                                                                   model_setting(stage, plan.scene->fluid.inertia));
      tension += core::tension_at(instance, prestretch);
    }
    most = std::max(most, 3 * std::abs(tension) * (sphere != nullptr ? 2 : 1) * stage.units.length / radius);
  }
  return most;
}

/// Whether a run is about when things happen, which is late by as much as the flow: cells that turn over or meet others. A round
/// cell alone becomes steady and forgets its start. `auto` is told which.
bool reports_moments(const Plan& plan) {
  if (plan.numerics_choice) return plan.has_cells && !plan.numerics_choice->steady;
  if (plan.scene->cells.size() != 1) return plan.has_cells;
  const scene::Shape& shape = plan.scene->cell_types[plan.scene->cells.front().type].shape;
  return !std::holds_alternative<scene::Circle>(shape) && !std::holds_alternative<scene::Sphere>(shape);
}

/// Of a cell type's membrane, Es/(mu a), 1/s: Es is a third of the stretching stiffness, as of a neo-Hookean one.
double recovery_rate(const Plan& plan, const scene::StageSetting& stage, std::size_t type) {
  const plugin::ModelSetting setting = model_setting(stage, plan.scene->fluid.inertia);
  double stiffness = 0;
  for (const PlannedModel& law : plan.membranes[type]) {
    if (law.active())
      stiffness +=
          core::stretching_stiffness(plugin::make_membrane_law(*law.manifest, law.parameters.values, setting), {1.0});
  }
  const double radius = shape::shape_radius(plan.scene->cell_types[type].shape) / stage.units.length;
  return stiffness / (3 * core::viscosity_of(stage.tau) * radius * stage.units.time);
}

/// Strain within which the cell type that takes longest comes to its steady shape.
double slowest_relaxation(const Plan& plan, const scene::StageSetting& stage) {
  double slowest = 0;
  for (std::size_t t = 0; t < plan.membranes.size(); ++t) {
    const double capillary = scene::mean_shear_rate(*stage.stage, *plan.scene) / recovery_rate(plan, stage, t);
    const double ratio = plan.scene->cell_types[t].interior_viscosity / plan.scene->fluid.viscosity;
    slowest = std::max(slowest, capsule_relaxation(std::min(capillary, largest_measured_capillary), ratio));
  }
  return slowest;
}

/// Of the developed flow between walls at rest, lattice units.
double fastest_driven_speed(const scene::StageSetting& stage, const scene::Scene& scene) {
  const double height = scene::wall_distance(scene.domain) / stage.units.length;
  const double viscosity = core::viscosity_of(scene.numerics.tau), drive = stage.largest_drive(scene.domain);
  if (scene.domain.tube_radius) return drive * height * height / (16 * viscosity);
  if (scene.fluid.layers.empty() || scene.domain.periodic_y) return drive * height * height / (8 * viscosity);
  double fastest = 0;
  const std::vector<double> rows = core::viscosity_of_rows(scene::lattice_layers(scene), scene.domain.nodes[1]);
  for (const core::ProfilePoint& point : core::layered_profile(rows, viscosity, {}, drive))
    fastest = std::max(fastest, std::abs(point.velocity));
  return fastest;
}

/// Volume that leaks out of a cell while the flow strains by 1, over its volume, in three dimensions: second order in the spacing
/// (docs/stability.md, "What leaks").
double leak_of_strain(const scene::Scene& scene) {
  const double radius = shape::smallest_radius(scene) / scene::lattice_spacing(scene);
  return (scene.cells.size() > 1 ? leak_of_many : leak_of_one) / (radius * radius);
}

double stretching_gain_of(const Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  const scene::Numerics& n = scene.numerics;
  const bool thin = n.tau < least_tau_of_full_gain && (n.slip_correction || scene.domain.depth);
  const bool sharp_contrast =
      scene.domain.depth && plan.viscosity_contrast && membrane_coupling(n) == MembraneCoupling::sharp;
  return thin || n.tau > (sharp_contrast ? most_tau_of_sharp_contrast : most_tau) ? cautious_stretching_gain
                                                                                  : stretching_gain;
}

/// Relative change of the area of a cell at a wall: a force across walls is held by a pressure, force times half of the
/// distance from wall to wall.
double compression_by_held_force(const scene::StageSetting& stage, const scene::Scene& scene) {
  const Eigen::Vector3d force(0, stage.body_force_y, stage.body_force_z);
  const Eigen::Vector3d held = force - scene::unheld(force, scene.domain);
  const double height = scene.domain.height(), depth = scene.domain.is_duct() ? scene.domain.depth->size : 0;
  return 1.5 * (std::abs(held.y()) * height + std::abs(held.z()) * depth) / stage.units.length;
}

/// Red cells turn over later by up to half of that strain, at a strain of five (docs/stability.md, "Held forces come late"): with no more
/// than the target of auto that is a tenth of the target.
double largest_held_strain_of(const Plan& plan) {
  if (!plan.numerics_choice) return largest_held_strain;
  return std::min(largest_held_strain / held_on_companions, plan.numerics_choice->target);
}

}  // namespace

double depth_over_bending(const Plan& plan, const scene::Interaction& interaction, double depth,
                          const plugin::ModelSetting& setting) {
  double most = 0;
  for (const int type : interaction.between) {
    bool kept_apart = false;
    for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
      const scene::Interaction& other = plan.scene->interactions[i];
      kept_apart = kept_apart || (other.with_self() && other.between[0] == type && plan.interactions[i].active());
    }
    double bending = 0;
    for (const PlannedModel& law : plan.membranes[type]) {
      if (law.active())
        bending += core::bending_stiffness(plugin::make_membrane_law(*law.manifest, law.parameters.values, setting));
    }
    const double radius = shape::shape_radius(plan.scene->cell_types[type].shape) / setting.units.length;
    if (!kept_apart && bending > 0) most = std::max(most, depth * radius * radius / bending);
  }
  return most;
}

const KernelFacts& kernel_named(const std::string& name) {
  for (const KernelFacts& facts : kernels) {
    if (facts.name == name) return facts;
  }
  throw std::logic_error("no kernel is called " + name);
}

std::optional<RecoveryRates> recovery_rates(const Plan& plan) {
  if (!plan.has_cells) return std::nullopt;
  RecoveryRates rates{INFINITY, 0};
  const double share = plan.scene->domain.depth ? 0.75 : 1;  // a neo-Hookean surface has a stretching stiffness of 4 Es
  for (std::size_t t = 0; t < plan.membranes.size(); ++t) {
    const double rate = share * recovery_rate(plan, plan.stages.front(), t);
    rates = {std::min(rates.least, rate), std::max(rates.most, rate)};
  }
  return rates;
}

bool semi_implicit_gains(const Plan& plan) {
  const scene::Numerics& numerics = plan.scene->numerics;
  return numerics.tau >= kernel_named(numerics.kernel).semi_implicit_from;
}

double explicit_margin(const Plan& plan) {
  double margin = std::numeric_limits<double>::infinity();
  if (!plan.has_cells) return margin;
  for (const scene::StageSetting& stage : plan.stages) {
    const Stiffness nearest = membrane_stiffness(plan, model_setting(stage, plan.scene->fluid.inertia));
    margin = std::min({margin, nearest.stretching.margin(), nearest.bending.margin()});
  }
  return margin;
}

std::vector<Limit> find_limits(const Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  std::vector<Limit> limits;
  // `upper`: the value must stay below the limit; otherwise above it.
  int stage_index = 0;
  const auto add = [&](const std::string& name, double value, double limit, bool upper, const std::string& remedy,
                       RemediedBy remedied_by = RemediedBy::nothing, double power_of_density = 1) {
    if (!std::isfinite(value)) return;
    const double margin = upper ? (value > 0 ? limit / value : std::numeric_limits<double>::infinity()) : value / limit;
    limits.push_back({name, value, limit, margin, remedy, remedied_by, stage_index, power_of_density});
  };
  constexpr RemediedBy resolution = RemediedBy::resolution;
  const double tau = scene.numerics.tau;
  constexpr double least = 0.005;  // of tau - 1/2
  add("tau - 1/2", tau - 0.5, least, false, "raise numerics.tau above 0.505");
  const scene::ViscosityRange viscosity = scene::viscosity_range(scene.fluid);
  const double most_viscous_tau = relaxation_time_of(viscosity.most, scene);
  if (!scene.fluid.layers.empty()) {
    const double ratio = viscosity.least / scene.fluid.viscosity;
    add("tau - 1/2 in the layer of least viscosity", ratio * (tau - 0.5), least, false,
        "raise numerics.tau above " + number(0.5 + least / ratio, 4));
    add("tau - 1/2 in the layer of largest viscosity", most_viscous_tau - 0.5, most_layered_tau - 0.5, true,
        "lower numerics.tau");
  }
  if (scene.numerics.slip_correction || kernel_named(scene.numerics.kernel).kind == core::KernelKind::sharp6) {
    double inside = std::numeric_limits<double>::infinity();
    for (const scene::CellType& cell : scene.cell_types)
      if (cell.interior_viscosity < scene.fluid.viscosity)
        inside = std::min(inside, relaxation_time_of(cell.interior_viscosity, scene) - 0.5);
    add("tau - 1/2 inside the cells", inside, least_inside_corrected, false,
        "raise numerics.tau; or leave out the slip correction, with the kernel peskin4");
  }
  if (plan.semi_implicit) {
    const double from = kernel_named(scene.numerics.kernel).semi_implicit_from;
    add("tau of the semi-implicit step", tau, from == nowhere ? least_semi_implicit_tau : from, false,
        "raise numerics.tau: the semi-implicit step gains nothing at low viscosity");
  }

  for (const scene::StageSetting& stage : plan.stages) {
    const std::string where = " (stage " + stage.stage->name + ")";
    const std::string lower = "lower " + stage.stage->density_factor_key;
    stage_index = stage.index;
    // A factor that the scene gives a stage is not auto's to change.
    const bool chosen = plan.numerics_choice && plan.numerics_choice->has(stage.stage->density_factor_key);
    const RemediedBy density =
        stage.stage->has_own_density_factor() && !chosen ? RemediedBy::nothing : RemediedBy::density_factor;
    const plugin::ModelSetting setting = model_setting(stage, scene.fluid.inertia);
    if (stage.fastest_wall() != 0) {
      const std::string what = stage.stage->mean_wall_speed != 0 ? "the walls' speeds" : "shear_rate";
      add("Mach number of the walls" + where, units::mach_number(stage.fastest_wall()),
          scene::largest_wall_mach(scene.fluid.inertia), true, lower + " or " + what + ", or raise the resolution",
          density);
    }
    if (scene::has_walls(scene.domain) && stage.largest_drive(scene.domain) != 0) {
      const double speed = fastest_driven_speed(stage, scene);
      add("Mach number of the driven flow" + where, units::mach_number(speed), 0.1, true,
          lower + " or the driving force, or raise the resolution", density);
    }
    if (scene.domain.tube_radius && stage.index == 0) {
      add("radius of the tube in lattice spacings", *scene.domain.tube_radius / stage.units.length, least_tube_radius,
          false, "raise the resolution: the flow rate is off by up to 0.65 over the square of the radius", resolution);
    }
    if (stage.oscillation.any()) {
      const double frequency = stage.oscillation.frequency;
      add("time steps in a period of the oscillation" + where, 1 / frequency, fewest_steps_of_period(tau), false, lower,
          density);
      add("thickness of the layer that oscillates, sqrt(2 nu/omega), in lattice spacings" + where,
          std::sqrt(core::viscosity_of(tau) / (std::numbers::pi * frequency)), thinnest_layer, false,
          "raise the resolution, or " + lower, resolution);
      const double delay = scene::oscillation_delay(*stage.stage, scene);
      add("delay of the oscillation by density_factor, in radians" + where,
          std::max(0.0, stage.stage->density_factor - 1) * delay, 0.1, true,
          lower + ": the fluid is simulated heavier than it is and lags behind what drives it", density);
    }
    const double rate = scene::mean_shear_rate(*stage.stage, scene);
    const double strain = static_cast<double>(stage.max_steps) * stage.units.time * rate;
    if (const FlowStart start = flow_start(scene, stage.index); start.delay > 0 && strain > 0) {
      const double allowed = plan.numerics_choice ? plan.numerics_choice->target : largest_error_by_start;
      // auto has counted it already.
      const RemediedBy by = plan.numerics_choice ? RemediedBy::nothing : density;
      const std::string remedy = "let it start \"developed\", or " + (plan.has_cells ? lower : "give it more time");
      if (reports_moments(plan)) {
        // With convective inertia a dense fluid stands for a Reynolds number, and its start belongs to what is computed.
        if (!scene.fluid.inertia || plan.numerics_choice) {
          add("strain that the start of the flow costs, over that of the stage" + where, start.delay / strain,
              plan.numerics_choice ? allowed : largest_share_of_strain, true, remedy, by);
        }
      } else {
        double left = start.left_at(strain);
        if (plan.has_cells) left = capsule_left(start, slowest_relaxation(plan, stage), strain);
        add("what the start of the flow leaves at the end of the stage, over the whole" + where, left, allowed, true,
            remedy, by);
        add("what the start of the flow leaves in the relative viscosity" + where, start.left_of_viscosity(strain),
            allowed, true, remedy, by);
      }
    }
    if (!plan.has_cells) continue;
    if (rate > 0) {
      add("compression of cells by the shear" + where, compression_by_shear(most_viscous_tau, rate * stage.units.time),
          largest_compression_by_shear, true, lower + " or numerics.tau: pressure compresses the lattice's fluid",
          density);
    }
    if (const double compression = compression_by_held_force(stage, scene); compression > 0) {
      add("compression of cells by a force across walls" + where, compression, largest_compression_by_shear, true,
          lower + " or fluid.body_force: the walls' pressure compresses the lattice's fluid", density);
    }
    if (rate > 0 && scene.domain.depth) {
      const bool kept = scene.numerics.area_correction;
      add(std::string(kept ? "volume kept in a cell while the flow strains by 1, as measured"
                           : "volume that a cell is expected to leak") +
              where,
          leak_of_strain(scene) * (kept ? 1 : strain), scene.checks.area_drift, true,
          kept ? "raise the resolution" : "set numerics.area_correction to true, or raise the resolution", resolution);
    }
    const CellTravel travel = cell_travel(scene, stage);
    if (scene.domain.depth && travel.mean > 0) {
      add("Reynolds number of cells that move through the lattice, without convective inertia" + where, travel.mean,
          0.05, true, lower + ", or set fluid.inertia to true: cells would drift across the flow wrongly", density);
    }
    if (travel.spread > 0) {
      add("Reynolds number of cells that pass each other, without convective inertia" + where, travel.spread, 0.05,
          true, lower + ", or set fluid.inertia to true: cells would drift across the flow wrongly", density);
    }
    const Stiffness membrane = membrane_stiffness(plan, setting);
    const bool gains = plan.semi_implicit && semi_implicit_gains(plan);
    const std::string coupled = plan.semi_implicit ? ", semi-implicit step" : " in lattice units";
    const bool zigzags = kernel_named(scene.numerics.kernel).semi_implicit_from == nowhere;
    const std::string softer = lower + ", with which the lattice stiffness falls" +
                               (zigzags              ? ", or set numerics.kernel to \"peskin4\""
                                : plan.semi_implicit ? ""
                                                     : ", or set numerics.coupling to \"semi-implicit\"");
    const double loss = plan.semi_implicit && zigzags ? semi_implicit_loss : 1;
    add("stretching stiffness" + coupled + where, membrane.stretching.value,
        (gains ? stretching_gain_of(plan) : loss) * membrane.stretching.limit, true, softer, density);
    add("bending stiffness" + coupled + where, membrane.bending.value,
        (gains ? bending_gain : loss) * membrane.bending.limit, true, softer, density);
    if (gains && rate > 0 && scene.domain.depth) {
      add("strain during which the semi-implicit step holds forces" + where,
          membrane.steps_of_mean * rate * stage.units.time, largest_held_strain_of(plan), true,
          lower + ": membranes turn against the forces that they hold", density, 2);
    }
    if (membrane.slip_smoothing > 0 && rate > 0 && reports_moments(plan)) {
      add("smoothing of the slip, variance over radius^2" + where, membrane.slip_smoothing,
          plan.numerics_choice ? plan.numerics_choice->target : largest_slip_smoothing, true,
          lower +
              " or raise the resolution: stiff membranes need their slip smoothed, and cells turn over late, or early, by half of this",
          density);
    }
    if (const double compression = prestress_compression(plan, stage); compression > 0) {
      add("compression of cells by their prestress, 3 T/a" + where, compression, 1e-3, true,
          lower + ": pressure compresses the lattice's fluid the more, the longer the time step", density);
    }
    for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
      const PlannedModel& model = plan.interactions[i];
      const bool wall = scene.interactions[i].with_wall(), self = scene.interactions[i].with_self();
      if (!model.active()) continue;
      if (!model.manifest->state.empty()) continue;  // its stiffness is a matter of what it remembers
      const PotentialShape shape = find_shape(plugin::ModelInstance(*model.manifest, model.parameters.values, setting));
      const auto same = [&](const PlannedModel& other) { return other.manifest->id == model.manifest->id; };
      const bool several = std::count_if(plan.interactions.begin(), plan.interactions.end(), same) > 1;
      const std::string named = model.manifest->id + (several ? " (" + plan.owner_of(model) + ")" : "");
      add("contact stiffness of " + named + " in lattice units" + where, shape.stiffness,
          interpolate(contact_limit, tau), true, lower + ", with which the lattice stiffness falls", density);
      if (shape.well && shape.well->distance >= least_gap) {
        add("compression by the attraction of " + named + where, 3 * shape.well->attraction,
            largest_compression_by_attraction, true,
            lower + ": the lattice's fluid gives way to it, and cells leak while they snap together", density);
      }
      if (stage.index != 0) continue;
      if (shape.well && shape.well->distance >= least_gap && !wall && !self && scene.cells.size() > 1) {
        const scene::Interaction& interaction = scene.interactions[i];
        const double depth = depth_over_bending(plan, interaction, shape.well->depth, setting);
        const std::string type = in_quotes(scene.cell_types[interaction.between[0]].name);
        if (depth > 0) {
          add("depth of " + named + " over bending modulus / radius^2, without a repulsion within membranes", depth,
              scene.domain.depth ? deepest_well_of_bare_surfaces : deepest_well_of_bare_faces, true,
              "cells that come to rest may be squeezed until their own faces touch; add an interaction between [" +
                  type +
                  ", \"self\"], such as \"repulsion\" with about three times the well's depth and a cutoff below the cells' "
                  "least thickness");
        }
      }
      if (shape.well) {
        add("equilibrium gap of " + named + " in lattice spacings", shape.well->distance, least_gap, false,
            std::string("raise the resolution or move the well outwards: where the lattice does not resolve the gap, "
                        "membranes ") +
                (wall ? "never leave the wall" : "never separate"),
            resolution);
        add("width of the well of " + named + " in lattice spacings", shape.well->width(),
            wall ? narrowest_well_of_a_wall : narrowest_well, false,
            std::string("raise the resolution or take a wider well: the corners of membranes catch ") +
                (wall ? "in" : "on each other in") + " a narrow one",
            resolution);
      } else {
        add("range of the repulsion of " + named + " in lattice spacings", shape.range, 2.0, false,
            wall ? "raise the resolution or the range: nearer than that the lattice holds a membrane to the wall, "
                   "whatever acts between them"
                 : "raise the resolution or the range: nearer than that the lattice moves two membranes together, "
                   "whatever acts between them",
            resolution);
      }
    }
    if (stage.index != 0) continue;
    double shortest = 1e300, longest = 0;
    std::vector<double> spacing_of_type;
    for (const scene::CellType& type : scene.cell_types) spacing_of_type.push_back(shape::node_spacing(type));
    for (const scene::CellPlacement& cell : scene.cells) {
      const double segment = spacing_of_type[cell.type] / stage.units.length;
      shortest = std::min(shortest, segment);
      longest = std::max(longest, segment);
    }
    const StartGaps gaps = start_gaps(scene);
    add("gap between cells, as placed, in lattice spacings", gaps.cells, least_gap_at_start, false,
        "move them apart, or raise the resolution: nearer than that the lattice moves two membranes together, and what "
        "acts between them throws them apart or never parts them");
    add("gap between cells, as placed, and a wall in lattice spacings", gaps.walls, least_gap_at_start, false,
        "move cells away from the wall, or raise the resolution: nearer than that the lattice holds them to it");
    add("gap between cells, as placed, and the wall of the tube in lattice spacings", gaps.tube, least_gap_to_tube,
        false,
        "raise the resolution, or move cells towards the axis: nearer than that they move too fast, on the wall by a "
        "third of a spacing times the shear rate",
        resolution);
    add("cell radius in lattice spacings", shape::smallest_radius(scene) / stage.units.length,
        least_radii(scene, membrane_coupling(scene.numerics)).run, false,
        "raise the resolution; results are converged from about 20", resolution);
    const bool space = scene.domain.depth.has_value();
    const std::string piece = space ? "edge" : "segment", pieces = space ? "triangles" : "segments";
    const std::string best = space ? "edges of about one spacing" : "about one for each spacing";
    add("shortest " + piece + " in lattice spacings", shortest, 0.4, false,
        "take fewer " + pieces + "; " + best + (space ? " are best" : " is best"));
    add("longest " + piece + " in lattice spacings", longest, longest_segment, true,
        "take more " + pieces + ", " + best + ": fluid leaks between nodes that lie far apart");
  }
  std::stable_sort(limits.begin(), limits.end(), [](const Limit& a, const Limit& b) { return a.margin < b.margin; });
  return limits;
}

}  // namespace rouleau::plan
