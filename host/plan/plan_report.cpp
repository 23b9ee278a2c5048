#include "plan_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.hpp"
#include "constants.hpp"
#include "core/solver/schedule.hpp"
#include "scene/driving_flow.hpp"
#include "scene/lattice.hpp"
#include "scene/scene_reader.hpp"
#include "shape/extent.hpp"
#include "shape/random_cells.hpp"

namespace rouleau::plan {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// Per volume, that of what pulls at cells included.
scene::Vector outer_force(const scene::Stage& stage, const scene::Scene& scene) {
  scene::Vector force = scene::driving_force(stage, scene);
  double magnitude = force.norm();
  for (const scene::CellForce& pull : stage.forces) {
    const auto count = static_cast<double>(pull.cells.empty() ? scene.cells.size() : pull.cells.size());
    const scene::Vector part = count / scene.domain.content() * pull.force;
    force += part, magnitude += part.norm();
  }
  return force.norm() > 1e-9 * magnitude ? force : scene::Vector();
}

/// A force on a fluid that is periodic along all axes meets no wall that could balance it.
bool accelerates_for_ever(const scene::StageSetting& stage, const scene::Scene& scene) {
  return !scene::has_walls(scene.domain) && outer_force(*stage.stage, scene) != scene::Vector();
}

/// Share of the domain's area or volume that all cells enclose at rest.
double hematocrit(const scene::Scene& scene) {
  std::vector<double> enclosed;
  for (const scene::CellType& type : scene.cell_types) enclosed.push_back(shape::enclosed_by(type));
  double sum = 0;
  for (const scene::CellPlacement& cell : shape::cells_at_once(scene)) sum += enclosed[cell.type];
  return sum / scene.domain.content();
}

std::map<std::string, double> dimensionless_numbers(const Plan& plan, const std::vector<InteractionWell>& wells) {
  const scene::Scene& scene = *plan.scene;
  double shear_rate = 0, factor = scene.numerics.density_factor, wall_mach = 0;
  bool unbounded = false;
  for (const scene::StageSetting& stage : plan.stages) {
    wall_mach = std::max(wall_mach, units::mach_number(stage.fastest_wall()));
    unbounded = unbounded || accelerates_for_ever(stage, scene);
    const double rate = scene::mean_shear_rate(*stage.stage, scene);
    if (rate > shear_rate) {
      shear_rate = rate;
      factor = stage.stage->density_factor;
    }
  }
  // A flow that nothing holds has no rate of its own; a number made with zero would look like a fluid at rest.
  if (unbounded && shear_rate == 0) shear_rate = undefined;
  const double radius = plan.has_cells ? shape::shape_radius(scene.cell_types[scene.cells[0].type].shape)
                                       : scene::wall_distance(scene.domain) / 2;
  const double stress = scene.fluid.viscosity * shear_rate;
  const double reynolds = scene.fluid.density * shear_rate * radius * radius / scene.fluid.viscosity;
  double ratio = 1;  // the one furthest from 1
  for (const scene::CellType& type : scene.cell_types) {
    const double of_type = type.interior_viscosity / scene.fluid.viscosity;
    if (std::abs(std::log(of_type)) > std::abs(std::log(ratio))) ratio = of_type;
  }

  return {{"reynolds_physical", reynolds},
          {"reynolds_simulated", reynolds * factor},
          {"capillary", stress * radius / shear_modulus(plan)},
          {"membrane_strain", plan.has_cells ? stress * radius / stretching_modulus(plan, plan.facts) : undefined},
          {"adhesion_number", stress > 0 ? deepest_well(plan, wells) / (stress * radius) : undefined},
          {"viscosity_ratio", plan.has_cells ? ratio : undefined},
          {"hematocrit", hematocrit(scene)},
          {"mach_wall", wall_mach}};
}

std::vector<PackedCells> packed_cells(const scene::Scene& scene) {
  std::vector<PackedCells> packed;
  for (const scene::RandomPacking& packing : scene.packings) {
    packed.push_back({.pointer = packing.pointer,
                      .type = scene.cell_types[packing.type].name,
                      .cells = {packing.first, packing.first + packing.count - 1},
                      .count = packing.count,
                      .hematocrit_asked = packing.hematocrit.value_or(undefined),
                      .hematocrit = packing.reached,
                      .seed = packing.seed,
                      .gap_m = packing.gap});
  }
  return packed;
}

/// Closest points on others' membranes, or on a cell's own.
bool looks_for_neighbours(const Plan& plan) { return plan.has_interactions || plan.has_self_interactions; }

std::vector<PlannedPass> planned_passes(const Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  const bool slip = scene.numerics.slip_correction, area = scene.numerics.area_correction;
  std::vector<std::string> parties;
  if (plan.has_interactions) parties.emplace_back("between cells");
  if (plan.has_wall_interactions) parties.emplace_back("between cells and walls");
  if (plan.has_self_interactions) parties.emplace_back("within a membrane");
  const std::map<std::string, std::string> reasons{
      {"membrane", std::to_string(shape::cells_at_once(scene).size()) + " cells resist deformation" +
                       (plan.semi_implicit ? "; semi-implicit step" : "")},
      {"interaction", "an active potential acts " + listed(parties)},
      {"corrections", slip ? (area ? "membranes neither slip nor leak" : "membranes do not slip")
                           : std::string("cells keep their ") + scene.domain.words().contents},
      {"indicator", "inside and outside of a cell have different viscosities"},
      {"activity", "marks the nodes near membranes, which alone carry force and velocity"},
      {"spread", "membrane forces act on the fluid"},
      {"fluid", "collision and streaming"},
      {"interpolate", "membranes move with the fluid"},
      {"move", "new positions of membrane nodes"}};
  const core::StepFeatures features{.cells = plan.has_cells,
                                    .interactions = looks_for_neighbours(plan),
                                    .wall_interactions = plan.has_wall_interactions,
                                    .viscosity_contrast = plan.viscosity_contrast,
                                    .slip_correction = plan.has_cells && slip,
                                    .area_correction = plan.has_cells && area};
  std::vector<PlannedPass> passes;
  for (const std::string& name : core::pass_names(features)) passes.push_back({name, reasons.at(name)});
  return passes;
}

std::vector<Omission> omissions(const Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  std::vector<Omission> left_out;
  const auto omit = [&](const std::string& what, const std::string& why) { left_out.push_back({what, why}); };
  const auto omit_inactive = [&](const std::string& what, const PlannedModel& model) {
    if (model.active()) return;
    omit(what + " " + model.manifest->id,
         plan.has_cells ? "inactive at these parameters (" + model.manifest->inactive_when.dump() + " in its manifest)"
                        : "the scene has no cells");
  };
  if (!plan.has_cells) {
    omit("membranes, force and velocity fields, interpolation", "the scene has no cells");
    for (const scene::CellType& type : scene.cell_types)
      omit("cell type " + type.name, "no cell of this type is placed");
  } else {
    if (!plan.viscosity_contrast)
      omit("indicator and relaxation rate field", "interior and suspending fluid have the same viscosity");
    if (!scene.numerics.slip_correction)
      omit("slip correction",
           "numerics.slip_correction is false: membranes slip to first order in the lattice spacing");
    if (!scene.numerics.area_correction)
      omit("area correction",
           std::string("numerics.area_correction is false: leaks show as ") + scene.domain.words().content + " drift");
    if (!looks_for_neighbours(plan)) {
      omit("neighbour search", scene.interactions.empty()   ? "the scene has no interaction"
                               : plan.has_wall_interactions ? "no interaction between cells is active"
                                                            : "no interaction is active");
    }
  }
  for (const PlannedModel& model : plan.interactions) omit_inactive("interaction", model);
  for (const auto& laws : plan.membranes) {
    for (const PlannedModel& law : laws)
      if (plan.has_cells) omit_inactive("membrane law", law);
  }
  if (!scene.fluid.inertia) {
    const bool follows = std::any_of(plan.facts.stages.begin(), plan.facts.stages.end(),
                                     [](const StageFacts& stage) { return stage.follows_cells; });
    omit("convective inertia", std::string("fluid.inertia is false: linear (Stokes) equilibrium") +
                                   (follows ? ", its unsteady term in a frame that moves with the cells" : ""));
  }
  if (!scene.output.checkpoint_seconds) omit("checkpoints", "output.checkpoint is \"never\": a run cannot be resumed");
  if (scene.output.fields.never()) omit("fields in frames.h5", "output.fields is not set");
  if (scene.output.cells.never())
    omit(plan.has_cells ? "rows of the tables and outlines between the ends of stages"
                        : "rows of series.csv between the ends of stages",
         "output.cells is not set; the start and the end of each stage are written");
  return left_out;
}

/// Whether one layer ends where another begins.
bool is_shared(const scene::Scene& scene, double border) {
  const auto& layers = scene.fluid.layers;
  return std::any_of(layers.begin(), layers.end(), [&](const scene::FluidLayer& layer) {
    return std::abs(layer.to - border) < 1e-9 * scene.domain.size.y();
  });
}

/// Of walls of any shape.
void add_wall_warnings(const scene::Scene& scene, std::vector<std::string>& warnings) {
  const scene::Domain& domain = scene.domain;
  for (const std::string& pointer : domain.obstacles_outside)
    warnings.push_back(pointer + " lies wholly outside of the domain; move it, or leave it out");
  if (domain.passages && domain.passages->unseen.thickness > 0) {
    constexpr double sure = 1.5;  // links are up to the root of 2 spacings long
    const auto& [thickness, at] = domain.passages->unseen;
    const double spacing = scene::lattice_spacing(scene);
    warnings.push_back(
        "the wall at (" + scene::by_axes(at, 1e6, 5, " um", ", ") + ") is " + number(thickness * spacing * 1e6, 3) +
        " um thick, and the flow goes through it between two nodes of the lattice; make it " +
        number(sure * spacing * 1e6, 3) + " um thick, or take " +
        number(std::ceil(sure / thickness * domain.nodes[0]), 12) + " nodes along x and as many more along the others");
  }
  if (const auto& passages = domain.passages; passages && passages->apart > 0)
    warnings.push_back(number(passages->apart, 12) +
                       " nodes of fluid have no way to most others, such as the one at (" +
                       scene::by_axes(passages->apart_at, 1e6, 5, " um", ", ") +
                       "); they are computed, and mean values count them. Close them with an obstacle, or open a way");
  if (domain.has_shapes() && !domain.passages)
    warnings.emplace_back(
        "the lattice is too large to look for narrow or closed passages between its walls; try a coarser "
        "one first");
}

/// What the user has to know before the run.
std::vector<std::string> warnings_of(const Plan& plan, const std::vector<Limit>& limits,
                                     const std::vector<InteractionWell>& wells) {
  const scene::Scene& scene = *plan.scene;
  std::vector<std::string> warnings = code_of_the_scene(plan);
  const auto add_those_of = [&](const std::vector<PlannedModel>& models) {
    for (const PlannedModel& model : models)
      warnings.insert(warnings.end(), model.parameters.warnings.begin(), model.parameters.warnings.end());
  };
  add_those_of({plan.collision});
  for (const std::vector<PlannedModel>& laws : plan.membranes) add_those_of(laws);
  add_those_of(plan.interactions);
  for (const scene::StageSetting& stage : plan.stages) {
    if (!accelerates_for_ever(stage, scene)) continue;
    const double factor = stage.stage->density_factor;
    const double acceleration = outer_force(*stage.stage, scene).norm() / scene.fluid.density;
    const std::string simulated = ", which as it is simulated, " + number(factor, 4) + " times as dense (" +
                                  stage.stage->density_factor_key + "), is " + number(acceleration / factor, 3) +
                                  " m/s";
    warnings.push_back("stage " + stage.stage->name + " drives a fluid that is periodic along " +
                       scene.domain.words().axes + ", so no wall holds it and it gains " + number(acceleration, 3) +
                       " m/s every second" + (factor != 1 ? simulated : "") +
                       ", for as long as the stage lasts; give domain.y walls, or leave out fluid.body_force and "
                       "pressure_gradient, or balance the forces on cells");
  }
  if (const int ranks = scene::fewest_ranks(scene.domain); ranks > 1) {
    warnings.push_back("the lattice has " + number(scene.domain.node_count(), 12) + " nodes and one rank can compute " +
                       std::to_string(scene::most_nodes_of_block) + "; start the run on " + std::to_string(ranks) +
                       " ranks or more (docs/ranks.md)");
  }
  add_wall_warnings(scene, warnings);
  const double spacing = scene::lattice_spacing(scene);
  for (const scene::FluidLayer& layer : scene.fluid.layers) {
    for (const double border : {layer.from, layer.to}) {
      const double row = border / spacing, nearest = std::round(row);
      if (std::abs(row - nearest) < 1e-6 || (border == layer.from && is_shared(scene, border))) continue;
      warnings.push_back("the border of a layer at " + number(border * 1e6, 6) +
                         " um lies within a row of nodes, whose velocity is off to first order in the spacing; at " +
                         number(nearest * spacing * 1e6, 6) + " um it lies between two rows");
    }
  }
  if (const KernelFacts& kernel = kernel_named(scene.numerics.kernel); plan.has_cells && *kernel.defect != 0)
    warnings.push_back(std::string("kernel ") + kernel.name + ": " + kernel.defect);
  // Models that remember, such as bonds, may attract too, though they have no well.
  const bool only_repulsion = deepest_well(plan, wells) == 0 &&
                              std::all_of(plan.interactions.begin(), plan.interactions.end(),
                                          [](const PlannedModel& model) { return model.manifest->state.empty(); });
  if (scene.numerics.slip_correction && !scene.numerics.area_correction && plan.has_interactions && !only_repulsion) {
    warnings.emplace_back(
        "numerics.slip_correction with attracting cells: what presses cells together leaks plasma into them "
        "(docs/results/contacts-2d.md); set numerics.area_correction to true as well");
  }
  if (scene.domain.dimension() == 3 && scene.cells.size() > 1 && !scene.numerics.slip_correction) {
    warnings.emplace_back(
        "numerics.slip_correction is false: in three dimensions plasma hardly drains from between cells then, so that "
        "they pass each other too far apart, suspensions are too viscous, and cells in contact stay together that "
        "should part (docs/three-dimensions.md, \"Cells that pass each other\"); set it and numerics.area_correction "
        "to true and numerics.kernel to \"sharp6\"");
  }
  for (const InteractionWell& well : wells) {
    const std::string named = well.model + " between " + well.between[0] + " and " + well.between[1] + ": ";
    if (!well.doubt.empty()) warnings.push_back(named + well.doubt);
    const bool of_cells = well.between[1] != scene::wall_name && well.between[1] != scene::self_name;
    const double gap = scene.output.aggregate_gap;
    if (of_cells && scene.cells.size() > 1 && well.well.attracts() && well.well.distance >= gap)
      warnings.push_back(named + "cells come to rest " + number(well.well.distance * 1e6, 3) +
                         " um apart, and output.aggregate_gap is " + number(gap * 1e6, 3) +
                         " um, so that no contact is counted; raise it above the first");
  }
  const std::optional<NumericsChoice>& choice = plan.numerics_choice;
  if (choice && !choice->doubt.empty()) warnings.push_back(choice->doubt);
  for (const Limit& limit : limits) {
    if (!(limit.margin < 1)) continue;
    warnings.push_back(limit.name + " is " + number(limit.value, 4) +
                       (limit.value > limit.limit ? ", above" : ", below") + " its limit of " + number(limit.limit, 4) +
                       "; " + limit.remedy);
  }
  return warnings;
}

std::vector<LateStart> late_starts(const Plan& plan) {
  constexpr double slight = 0.01;
  std::vector<LateStart> found;
  if (!plan.has_cells) return found;  // how the flow starts is what is computed
  for (const scene::StageSetting& stage : plan.stages) {
    const StageFacts& facts = plan.facts.stages[stage.index];
    const double late = facts.start.delay, strain = facts.strain;
    if (late > slight * strain && strain > 0)
      found.push_back({stage.stage->name, late, strain, scene::knows_developed_flow(*stage.stage, *plan.scene)});
  }
  return found;
}

std::optional<BoxShare> box_share(const scene::Scene& scene) {
  const scene::Domain& domain = scene.domain;
  const bool sheared = std::any_of(scene.stages.begin(), scene.stages.end(),
                                   [](const scene::Stage& stage) { return stage.shear_rate != 0; });
  if (domain.dimension() == 2 || domain.is_duct() || !sheared || scene.cells.empty() || scene.cells.size() > 2)
    return {};
  double radius = 0;
  for (const scene::CellPlacement& cell : scene.cells)
    radius = std::max(radius, shape::shape_radius(scene.cell_types[cell.type].shape));
  const double radii = domain.size.least() / radius;
  return BoxShare{radii, box_share_at_eight * std::pow(8 / std::max(radii, smallest_box), 3), radii < smallest_box};
}

/// Of a run that takes hours; empty: it does not.
std::string long_run(const Plan& plan, const Estimate& estimate) {
  constexpr double hour = 3600, many = 3;
  if (!(estimate.wall_s > many * hour)) return {};
  const std::string shorter =
      plan.numerics_choice ? "a larger numerics.auto.error" : "a coarser lattice or a larger density_factor";
  return "the run takes about " + number(estimate.wall_s / hour, 3) + " hours on one core, " +
         number(estimate.steps, 3) + " steps of " + number(plan.scene->domain.node_count(), 3) + " nodes; " + shorter +
         " makes it shorter, and several threads or ranks do";
}

}  // namespace

PlanReport make_report(const Plan& plan) {
  PlanReport report;
  report.passes = planned_passes(plan);
  report.left_out = omissions(plan);
  report.limits = find_limits(plan);
  report.wells = plan.facts.wells;
  report.attracting = attracting_types(plan, report.wells);
  report.close_gap = plan.scene->output.aggregate_gap;
  report.warnings = warnings_of(plan, report.limits, report.wells);
  for (const MembraneFacts& membrane : plan.facts.stages.front().models->membranes)
    if (membrane.first) report.first_stretches.push_back(*membrane.first);
  for (const scene::CellType& type : plan.scene->cell_types)
    if (const std::string doubt = shape::doubt_of_rest(type); !doubt.empty()) report.warnings.push_back(doubt);
  report.dimensionless = dimensionless_numbers(plan, report.wells);
  report.conversions = conversion_table(plan);
  report.packings = packed_cells(*plan.scene);
  report.late_starts = late_starts(plan);
  report.box_share = box_share(*plan.scene);
  report.estimate = estimate(plan);
  if (const std::string words = long_run(plan, report.estimate); !words.empty()) report.warnings.push_back(words);
  return report;
}

}  // namespace rouleau::plan
