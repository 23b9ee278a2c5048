#include "limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/text.hpp"
#include "cell_limits.hpp"
#include "core/coupling/kernel_kind.hpp"
#include "core/fluid/relaxation.hpp"
#include "scene/driving_flow.hpp"

namespace rouleau::plan {

namespace {

/// Of all stages: the relaxation times of the fluid, of its layers and inside the cells.
void add_relaxation_times(const Plan& plan, LimitList& limits) {
  const scene::Scene& scene = *plan.scene;
  const double tau = scene.numerics.tau;
  limits.above("tau - 1/2", tau - 0.5, least_of_tau, "raise numerics.tau above 0.505");
  const scene::ViscosityRange viscosity = scene::viscosity_range(scene.fluid);
  if (!scene.fluid.layers.empty()) {
    const double ratio = viscosity.least / scene.fluid.viscosity;
    limits.above("tau - 1/2 in the layer of least viscosity", ratio * (tau - 0.5), least_of_tau,
                 "raise numerics.tau above " + number(0.5 + least_of_tau / ratio, 4));
    limits.below("tau - 1/2 in the layer of largest viscosity", relaxation_time_of(viscosity.most, scene) - 0.5,
                 most_layered_tau - 0.5, "lower numerics.tau");
  }
  const KernelFacts& kernel = kernel_named(scene.numerics.kernel);
  if (scene.numerics.slip_correction || kernel.kind == core::KernelKind::sharp6) {
    double inside = std::numeric_limits<double>::infinity();
    for (const scene::CellType& cell : scene.cell_types)
      if (cell.interior_viscosity < scene.fluid.viscosity)
        inside = std::min(inside, relaxation_time_of(cell.interior_viscosity, scene) - 0.5);
    limits.above("tau - 1/2 inside the cells", inside, least_inside_corrected,
                 "raise numerics.tau; or leave out the slip correction, with the kernel peskin4");
  }
  if (plan.semi_implicit) {
    const double from = kernel.semi_implicit_from;
    limits.above("tau of the semi-implicit step", tau, from == nowhere ? least_semi_implicit_tau : from,
                 "raise numerics.tau: the semi-implicit step gains nothing at low viscosity");
  }
}

void add_mach_numbers(const LimitedStage& of, LimitList& limits) {
  const scene::StageSetting& stage = of.stage;
  if (stage.fastest_wall() != 0) {
    const std::string what =
        stage.stage->mean_wall_speed != 0 || stage.shape_speed > 0 ? "the walls' speeds" : "shear_rate";
    limits.below("Mach number of the walls" + of.where, units::mach_number(stage.fastest_wall()),
                 scene::largest_wall_mach(of.scene.fluid.inertia),
                 of.lower + " or " + what + ", or raise the resolution", of.density);
  }
  if (scene::has_walls(of.scene.domain) && stage.largest_drive(of.scene.domain) != 0) {
    limits.below("Mach number of the driven flow" + of.where, units::mach_number(fastest_driven_speed(stage, of.scene)),
                 largest_driven_mach, of.lower + " or the driving force, or raise the resolution", of.density);
  }
}

std::string micrometres(const scene::Vector& place) { return '(' + scene::by_axes(place, 1e6, 5, " um", ", ") + ')'; }

void add_tube(const LimitedStage& of, LimitList& limits) {
  if (!of.scene.domain.tube_radius) return;
  limits.above("radius of the tube in lattice spacings", *of.scene.domain.tube_radius / of.stage.units.length,
               least_tube_radius, "raise the resolution: the flow rate is off by up to 1 over the square of the radius",
               RemediedBy::resolution);
}

void add_passages(const LimitedStage& of, LimitList& limits) {
  if (!of.scene.domain.passages) return;
  const scene::Passages& passages = *of.scene.domain.passages;
  limits.above("narrowest passage between walls in lattice spacings, at " + micrometres(passages.narrowest_at),
               passages.narrowest, narrowest_passage,
               "raise the resolution: the flow through it is off by several per cent", RemediedBy::resolution);
}

void add_oscillation(const LimitedStage& of, LimitList& limits) {
  if (of.stage.oscillation.frequency == 0) return;
  const double frequency = of.stage.oscillation.frequency, half = of.scene.numerics.tau - 0.5;
  limits.above("time steps in a period of the oscillation" + of.where, 1 / frequency, steps_of_period * half * half,
               of.lower, of.density);
  limits.above("thickness of the layer that oscillates, sqrt(2 nu/omega), in lattice spacings" + of.where,
               std::sqrt(core::viscosity_of(of.scene.numerics.tau) / (std::numbers::pi * frequency)), thinnest_layer,
               "raise the resolution, or " + of.lower, RemediedBy::resolution);
  const double delay = scene::oscillation_delay(*of.stage.stage, of.scene);
  limits.below("delay of the oscillation by density_factor, in radians" + of.where,
               std::max(0.0, of.stage.stage->density_factor - 1) * delay, largest_delay,
               of.lower + ": the fluid is simulated heavier than it is and lags behind what drives it", of.density);
}

/// A triangle of a membrane that treads is strained back and forth at most as fast as the flow shears. What forces
/// pull, and what comes back once they end, is to be seen within its stage.
void add_viscous_lag(const LimitedStage& of, LimitList& limits) {
  const bool pulled = std::any_of(of.scene.stages.begin(), of.scene.stages.end(),
                                  [](const scene::Stage& stage) { return !stage.forces.empty(); });
  const double rate = of.facts.shear_rate * of.stage.units.time +
                      2 * std::numbers::pi * of.stage.oscillation.frequency +
                      (pulled ? 1 / static_cast<double>(of.stage.max_steps) : 0);
  const double lag = of.facts.models->viscous_lag;
  if (!(rate * lag > 0)) return;
  limits.below("relative error of the stress of viscous membranes where it changes as fast as the flow" + of.where,
               rate * rate * lag * lag, largest_viscous_lag,
               of.lower + ": the stress lags by " + number(lag, 3) + " steps", of.density);
}

/// Strain within which the cell type that takes longest comes to its steady shape.
double slowest_relaxation(const LimitedStage& of) {
  double slowest = 0;
  const std::vector<MembraneFacts>& membranes = of.facts.models->membranes;
  for (std::size_t t = 0; t < membranes.size(); ++t) {
    const double capillary = of.facts.shear_rate / membranes[t].recovery_rate;
    const double ratio = of.scene.cell_types[t].interior_viscosity / of.scene.fluid.viscosity;
    slowest = std::max(slowest, capsule_relaxation(std::min(capillary, largest_relaxing_capillary), ratio));
  }
  return slowest;
}

void add_start(const LimitedStage& of, LimitList& limits) {
  const FlowStart& start = of.facts.start;
  const double strain = of.facts.strain;
  if (!(start.delay > 0) || !(strain > 0)) return;
  const std::optional<NumericsChoice>& choice = of.plan.numerics_choice;
  const double allowed = choice ? choice->target : largest_error_by_start;
  const RemediedBy by = choice ? RemediedBy::nothing : of.density;  // auto has counted it already
  const bool known = scene::knows_developed_flow(*of.stage.stage, of.scene);
  const std::string remedy =
      (known ? "let it start \"developed\", or " : "") + (of.plan.has_cells ? of.lower : "give it more time");
  if (reports_moments(of.plan)) {
    // With convective inertia a dense fluid stands for a Reynolds number, and its start belongs to what is computed.
    if (of.scene.fluid.inertia && !choice) return;
    limits.below("strain that the start of the flow costs, over that of the stage" + of.where, start.delay / strain,
                 choice ? allowed : largest_share_of_strain, remedy, by);
    return;
  }
  double left = start.left_at(strain);
  if (of.plan.has_cells) left = capsule_left(start, slowest_relaxation(of), strain);
  limits.below("what the start of the flow leaves at the end of the stage, over the whole" + of.where, left, allowed,
               remedy, by);
  limits.below("what the start of the flow leaves in the relative viscosity" + of.where,
               start.left_of_viscosity(strain), allowed, remedy, by);
}

/// The limits of a stage, in this order where they are equally sharp.
struct StageLimits {
  void (*add)(const LimitedStage& of, LimitList& limits);
  bool of_cells = false, of_first_stage = false;
};
constexpr std::array stage_limits{
    StageLimits{add_mach_numbers},
    StageLimits{.add = add_tube, .of_first_stage = true},
    StageLimits{.add = add_passages, .of_first_stage = true},
    StageLimits{add_oscillation},
    StageLimits{add_start},
    StageLimits{.add = add_compression, .of_cells = true},
    StageLimits{.add = add_leak, .of_cells = true},
    StageLimits{.add = add_travel, .of_cells = true},
    StageLimits{.add = add_forces_on_cells, .of_cells = true},
    StageLimits{.add = add_stiffness, .of_cells = true},
    StageLimits{.add = add_viscous_lag, .of_cells = true},
    StageLimits{.add = add_slip_and_prestress, .of_cells = true},
    StageLimits{.add = add_potentials, .of_cells = true},
    StageLimits{.add = add_gaps, .of_cells = true, .of_first_stage = true},
    StageLimits{.add = add_resolution, .of_cells = true, .of_first_stage = true},
};

}  // namespace

std::vector<Limit> find_limits(const Plan& plan) {
  LimitList limits;
  add_relaxation_times(plan, limits);
  for (const scene::StageSetting& stage : plan.stages) {
    limits.begin_stage(stage.index);
    const LimitedStage of(plan, stage);
    for (const StageLimits& each : stage_limits)
      if ((!each.of_cells || plan.has_cells) && (!each.of_first_stage || stage.index == 0)) each.add(of, limits);
  }
  return std::move(limits).sorted();
}

}  // namespace rouleau::plan
