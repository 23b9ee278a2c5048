#include "plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/text.hpp"
#include "cell_summary.hpp"
#include "core/coupling/kernel_kind.hpp"
#include "core/solver/schedule.hpp"
#include "json/document.hpp"
#include "json/number_or_null.hpp"
#include "kernel_facts.hpp"
#include "plan_models.hpp"
#include "scene/driving_flow.hpp"
#include "shape/outline.hpp"
#include "stability_limits.hpp"
#include "step_cost.hpp"

namespace rouleau::plan {

namespace {

PlannedModel plan_model(plugin::ModelKind kind, const scene::ModelChoice& choice, const scene::Scene& scene,
                        const plugin::Catalog& catalog, const units::Units& units, std::vector<std::string>& warnings) {
  const plugin::Manifest& manifest = catalog.find(kind, choice.model, scene.place(choice.pointer + "/model"));
  PlannedModel model{&manifest, plugin::resolve_parameters(choice, manifest, scene, units), choice.pointer};
  warnings.insert(warnings.end(), model.parameters.warnings.begin(), model.parameters.warnings.end());
  return model;
}

/// A force on a fluid that is periodic along both axes meets no wall that could balance it.
bool accelerates_for_ever(const StageSetting& stage, const scene::Scene& scene) {
  return scene.domain.periodic_y && scene::driving_force(*stage.stage, scene) != Eigen::Vector2d::Zero();
}

nlohmann::json dimensionless_numbers(const Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  double shear_rate = 0, factor = scene.numerics.density_factor, wall_mach = 0;
  bool unbounded = false;
  for (const StageSetting& stage : plan.stages) {
    wall_mach = std::max(wall_mach, units::mach_number(std::abs(stage.wall_speed)));
    unbounded = unbounded || accelerates_for_ever(stage, scene);
    const double rate = scene::mean_shear_rate(*stage.stage, scene);
    if (rate > shear_rate) {
      shear_rate = rate;
      factor = stage.stage->density_factor;
    }
  }
  // A flow that nothing holds has no rate of its own; a number made with zero would look like a fluid at rest.
  if (unbounded && shear_rate == 0) shear_rate = std::nan("");
  const double radius =
      scene.cell_types.empty() || scene.cells.empty()
          ? scene.domain.size.y() / 2
          : shape::shape_radius(scene.cell_types[static_cast<std::size_t>(scene.cells[0].type)].shape);
  const double stress = scene.fluid.viscosity * shear_rate;
  const double reynolds = scene.fluid.density * shear_rate * radius * radius / scene.fluid.viscosity;
  const double unsteady = reynolds * factor;
  double ratio = 1;
  for (const scene::CellType& type : scene.cell_types)
    ratio = std::max(ratio, type.interior_viscosity / scene.fluid.viscosity);

  nlohmann::json numbers;
  numbers["reynolds_physical"] = json::number_or_null(reynolds);
  numbers["reynolds_simulated"] = json::number_or_null(unsteady);
  numbers["capillary"] = json::number_or_null(stress * radius / shear_modulus(plan));
  numbers["membrane_strain"] =
      json::number_or_null(plan.has_cells ? stress * radius / stretching_modulus(plan) : std::nan(""));
  numbers["adhesion_number"] =
      stress > 0 ? json::number_or_null(deepest_well(plan) / (stress * radius)) : nlohmann::json();
  numbers["viscosity_ratio"] = plan.has_cells ? json::number_or_null(ratio) : nlohmann::json();
  numbers["hematocrit"] = hematocrit(scene);
  numbers["mach_wall"] = wall_mach;
  return numbers;
}

nlohmann::json conversion_table(const Plan& plan, const units::Units& units) {
  const scene::Scene& scene = *plan.scene;
  nlohmann::json table = nlohmann::json::array();
  for (const StageSetting& stage : plan.stages) {
    const auto row = [&](const std::string& quantity, double si, const std::string& unit, double lattice,
                         const std::string& of = {}) {
      table.push_back({{"stage", stage.stage->name},
                       {"quantity", quantity},
                       {"of", of},
                       {"si", json::number_or_null(si)},
                       {"unit", unit},
                       {"lattice", json::number_or_null(lattice)}});
    };
    const units::LatticeUnits& u = stage.units;
    row("spacing", u.length, "m", 1);
    row("time step", u.time, "s", 1);
    row("density (times density_factor)", scene.fluid.density * stage.stage->density_factor, "kg/m3", 1);
    row("viscosity", scene.fluid.viscosity, "Pa s", u.to_lattice(scene.fluid.viscosity, units::dimension::viscosity));
    if (stage.stage->shear_rate != 0) {
      row("shear rate", stage.stage->shear_rate, "1/s", stage.shear_rate);
      row("wall speed", u.to_si(stage.wall_speed, units::dimension::velocity), "m/s", stage.wall_speed);
    }
    if (stage.body_force_x != 0 || stage.body_force_y != 0) {
      row("driving force density", u.to_si(stage.body_force_x, units::dimension::force_density), "N/m3",
          stage.body_force_x);
    }
    row("width of the domain", scene.domain.size.x(), "m",
        u.to_lattice(scene.domain.size.x(), units::dimension::length));
    row("height of the domain", scene.domain.size.y(), "m",
        u.to_lattice(scene.domain.size.y(), units::dimension::length));
    for (const scene::CellType& type : scene.cell_types) {
      const double radius = shape::shape_radius(type.shape);
      row("radius", radius, "m", u.to_lattice(radius, units::dimension::length), type.name);
      row("interior viscosity", type.interior_viscosity, "Pa s",
          u.to_lattice(type.interior_viscosity, units::dimension::viscosity), type.name);
    }
    for (const PlannedModel* model : plan.active_models()) {
      const std::string owner = plan.owner_of(*model);
      for (std::size_t i = 0; i < model->manifest->parameters.size(); ++i) {
        const plugin::Parameter& parameter = model->manifest->parameters[i];
        if (!parameter.choices.empty()) continue;
        const auto& e = parameter.dimension.exponent;
        const bool stays_si = e[3] != 0 || e[4] != 0 || e[5] != 0;
        const double si = model->parameters.values[i];
        const bool in_si = units.scale(parameter.unit) == 1;
        row(model->manifest->id + ": " + parameter.name, si, in_si ? parameter.unit : "SI for " + parameter.unit,
            stays_si ? si : u.to_lattice(si, parameter.dimension), owner);
      }
    }
  }
  return table;
}

void plan_passes(Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  const auto omit = [&](const std::string& what, const std::string& why) { plan.left_out.push_back({what, why}); };

  const bool slip = scene.numerics.slip_correction, area = scene.numerics.area_correction;
  const std::map<std::string, std::string> reasons{
      {"membrane", std::to_string(scene.cells.size()) + " cells resist deformation" +
                       (plan.semi_implicit ? "; semi-implicit step" : "")},
      {"interaction", "an active potential acts between cells"},
      {"corrections",
       slip ? (area ? "membranes neither slip nor leak" : "membranes do not slip") : "cells keep their areas"},
      {"indicator", "inside and outside of a cell have different viscosities"},
      {"activity", "marks the nodes near membranes, which alone carry force and velocity"},
      {"spread", "membrane forces act on the fluid"},
      {"fluid", "collision and streaming"},
      {"interpolate", "membranes move with the fluid"},
      {"move", "new positions of membrane nodes"}};
  const core::Schedule schedule = core::make_schedule({.cells = plan.has_cells,
                                                       .interactions = plan.has_interactions,
                                                       .viscosity_contrast = plan.viscosity_contrast,
                                                       .slip_correction = plan.has_cells && slip,
                                                       .area_correction = plan.has_cells && area});
  for (const core::Step& step : schedule.steps) {
    const bool known = std::any_of(plan.passes.begin(), plan.passes.end(),
                                   [&](const PlannedPass& other) { return other.name == step.name; });
    if (!known) plan.passes.push_back({step.name, reasons.at(step.name)});
  }
  if (!plan.has_cells) {
    omit("membranes, force and velocity fields, interpolation", "the scene has no cells");
    for (const scene::CellType& type : scene.cell_types)
      omit("cell type " + type.name, "no cell of this type is placed");
  }
  if (plan.has_cells && !plan.viscosity_contrast) {
    omit("indicator and relaxation rate field", "interior and suspending fluid have the same viscosity");
  }
  if (plan.has_cells && !scene.numerics.slip_correction) {
    omit("slip correction", "numerics.slip_correction is false: membranes slip to first order in the lattice spacing");
  }
  if (plan.has_cells && !scene.numerics.area_correction) {
    omit("area correction", "numerics.area_correction is false: leaks show as area drift");
  }
  if (plan.has_cells && !plan.has_interactions) {
    omit("neighbour search", scene.interactions.empty() ? "the scene has no interaction" : "no interaction is active");
  }
  for (const PlannedModel& model : plan.interactions) {
    if (model.active()) continue;
    omit("interaction " + model.manifest->id,
         plan.has_cells ? "inactive at these parameters (" + model.manifest->inactive_when.dump() + " in its manifest)"
                        : "the scene has no cells");
  }
  for (const auto& type : plan.membranes) {
    for (const PlannedModel& model : type) {
      if (!model.active() && plan.has_cells) {
        omit("membrane law " + model.manifest->id,
             "inactive at these parameters (" + model.manifest->inactive_when.dump() + " in its manifest)");
      }
    }
  }
  if (!scene.fluid.inertia) omit("convective inertia", "fluid.inertia is false: linear (Stokes) equilibrium");
  if (!scene.output.checkpoint_seconds) omit("checkpoints", "output.checkpoint is \"never\": a run cannot be resumed");
  if (scene.output.fields.never()) omit("fields in frames.h5", "output.fields is not set");
  if (scene.output.cells.never())
    omit(plan.has_cells ? "rows of the tables and outlines between the ends of stages"
                        : "rows of series.csv between the ends of stages",
         "output.cells is not set; the start and the end of each stage are written");
}

void plan_estimate(Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  const double nodes = static_cast<double>(scene.domain.nodes[0]) * scene.domain.nodes[1];
  double membrane_nodes = 0;
  for (const scene::CellPlacement& cell : scene.cells)
    membrane_nodes += scene.cell_types[static_cast<std::size_t>(cell.type)].segments;
  for (const StageSetting& stage : plan.stages) plan.estimate.steps += static_cast<double>(stage.max_steps);
  plan.estimate.wall_s = plan.estimate.steps * step_cost(nodes, membrane_nodes, scene.numerics.precision);
  const double word = scene.numerics.precision == scene::Precision::f64 ? 8 : 4;
  plan.estimate.memory_bytes =
      nodes * word * (9 + (plan.has_cells ? 2 : 0) + (plan.viscosity_contrast ? 1 : 0)) + membrane_nodes * 400;
  plan.estimate.output = estimate_output(scene, plan.stages);
}

/// Every stage makes its models anew and has a row of the conversions for each of their parameters.
void check_models_of_stages(const scene::Scene& scene) {
  constexpr std::size_t most = 100'000;
  std::size_t models = 1 + scene.interactions.size();
  for (const scene::CellType& type : scene.cell_types) models += type.membrane.size();
  if (models * scene.stages.size() <= most) return;
  throw Error(Cause::bad_input, scene.place("/stages"),
              std::to_string(scene.stages.size()) + " stages with " + std::to_string(models) + " models each make " +
                  std::to_string(models * scene.stages.size()) + " models; at most " + std::to_string(most) +
                  " can be computed: use fewer stages, cell types, laws or interactions");
}

void choose_coupling(Plan& plan) {
  const std::string& wanted = plan.scene->numerics.coupling;
  if (!plan.has_cells) {
    plan.coupling = "none, for the scene has no cells";
    return;
  }
  if (wanted != "auto") {
    plan.semi_implicit = wanted == "semi-implicit";
    plan.coupling = wanted + ", as numerics.coupling says";
    return;
  }
  const double margin = explicit_margin(plan);
  const bool stiff = margin < comfortable_margin;
  plan.semi_implicit = stiff && semi_implicit_gains(plan);
  plan.coupling = std::string(plan.semi_implicit ? "semi-implicit" : "explicit") +
                  ", chosen by \"auto\": the explicit limit of the membranes' stiffness is " + number(margin, 3) +
                  " times what they have, " + (stiff ? "below " : "at least ") + number(comfortable_margin, 2) +
                  (stiff && !plan.semi_implicit ? "; at this numerics.tau the semi-implicit step would not help" : "");
}

nlohmann::json choice_json(const scene::NumericsChoice& choice) {
  nlohmann::json values = nlohmann::json::array();
  for (const scene::ChosenValue& chosen : choice.values) {
    values.push_back({{"pointer", chosen.pointer}, {"value", chosen.value}, {"why", chosen.why}});
  }
  return {{"target_error", choice.target},
          {"of", choice.steady ? "steady" : "motion"},
          {"values", values},
          {"expected_error", {{"resolution", choice.expected.resolution}, {"inertia", choice.expected.inertia}}}};
}

std::string warning_of(const Limit& limit) {
  return limit.name + " is " + number(limit.value, 4) + (limit.value > limit.limit ? ", above" : ", below") +
         " its limit of " + number(limit.limit, 4) + "; " + limit.remedy;
}

}  // namespace

std::string Plan::owner_of(const PlannedModel& model) const {
  const auto name = [&](int type) { return scene->cell_types[static_cast<std::size_t>(type)].name; };
  for (std::size_t type = 0; type < membranes.size(); ++type) {
    for (const PlannedModel& law : membranes[type]) {
      if (&law == &model) return name(static_cast<int>(type));
    }
  }
  for (std::size_t i = 0; i < interactions.size(); ++i) {
    if (&interactions[i] != &model) continue;
    const auto [a, b] = scene->interactions[i].between;
    return name(a) + ", " + name(b);
  }
  return {};
}

std::vector<const PlannedModel*> Plan::active_models() const {
  std::vector<const PlannedModel*> models{&collision};
  if (!has_cells) return models;
  for (std::size_t type = 0; type < membranes.size(); ++type) {
    const bool used = std::any_of(scene->cells.begin(), scene->cells.end(), [&](const scene::CellPlacement& cell) {
      return cell.type == static_cast<int>(type);
    });
    if (!used) continue;
    for (const PlannedModel& law : membranes[type]) {
      if (law.active()) models.push_back(&law);
    }
  }
  for (const PlannedModel& potential : interactions) {
    if (potential.active()) models.push_back(&potential);
  }
  return models;
}

Plan make_plan(const scene::Scene& scene, const plugin::Catalog& catalog) {
  check_models_of_stages(scene);
  const units::Units units;
  Plan plan{};
  plan.scene = &scene;
  if (catalog.lock()) plan.lock = {catalog.lock()->file.string(), catalog.lock()->sha256};
  plan.collision =
      plan_model(plugin::ModelKind::collision, scene.fluid.collision, scene, catalog, units, plan.warnings);
  for (const scene::CellType& type : scene.cell_types) {
    auto& laws = plan.membranes.emplace_back();
    for (const scene::ModelChoice& choice : type.membrane) {
      laws.push_back(plan_model(plugin::ModelKind::membrane, choice, scene, catalog, units, plan.warnings));
    }
  }
  plan.has_cells = !scene.cells.empty();
  for (const scene::Interaction& interaction : scene.interactions) {
    PlannedModel model =
        plan_model(plugin::ModelKind::interaction, interaction.potential, scene, catalog, units, plan.warnings);
    if (!plan.has_cells) model.parameters.inactive = true;
    plan.has_interactions = plan.has_interactions || model.active();
    plan.interactions.push_back(std::move(model));
  }
  for (const scene::CellPlacement& cell : scene.cells) {
    const scene::CellType& type = scene.cell_types[static_cast<std::size_t>(cell.type)];
    if (type.interior_viscosity != scene.fluid.viscosity) plan.viscosity_contrast = true;
  }
  for (int i = 0; i < static_cast<int>(scene.stages.size()); ++i) plan.stages.push_back(make_stage_setting(scene, i));
  for (const StageSetting& stage : plan.stages) {
    if (stage.stage->start == scene::WallStart::developed && scene.domain.periodic_y && stage.body_force_x != 0) {
      throw Error(
          Cause::bad_input, scene.place(stage.stage->pointer + "/start"),
          "\"developed\" wants walls: a driven flow that is periodic along y never becomes steady; leave start out");
    }
  }
  for (const StageSetting& stage : plan.stages) {
    if (!accelerates_for_ever(stage, scene)) continue;
    const double acceleration =
        scene::driving_force(*stage.stage, scene).norm() / (scene.fluid.density * stage.stage->density_factor);
    plan.warnings.push_back("stage " + stage.stage->name +
                            " drives a fluid that is periodic along x and y, so no wall holds it and it gains " +
                            number(acceleration, 3) +
                            " m/s every second for as long as the stage lasts; give domain.y walls, or leave out "
                            "fluid.body_force and pressure_gradient");
  }
  if (const KernelFacts& kernel = kernel_named(scene.numerics.kernel); plan.has_cells && *kernel.defect != 0) {
    plan.warnings.push_back(std::string("kernel ") + kernel.name + ": " + kernel.defect);
  }
  // Where auto has chosen it, it has looked at how strong the attraction is.
  const bool chosen = scene.numerics_choice &&
                      std::any_of(scene.numerics_choice->values.begin(), scene.numerics_choice->values.end(),
                                  [](const auto& value) { return value.pointer == "/numerics/slip_correction"; });
  if (scene.numerics.slip_correction && plan.has_interactions && !chosen) {
    plan.warnings.emplace_back(
        "numerics.slip_correction with attracting cells: where the attraction is strong, cells leak more with it than "
        "without (docs/accuracy.md); watch area_leakage_max, or set it to false");
  }
  if (scene.numerics_choice) {
    plan.numerics_choice = choice_json(*scene.numerics_choice);
    if (!scene.numerics_choice->doubt.empty()) plan.warnings.push_back(scene.numerics_choice->doubt);
  }
  choose_coupling(plan);
  plan_passes(plan);
  try_models(plan);
  plan.wells = describe_wells(plan);
  plan.dimensionless = dimensionless_numbers(plan);
  plan.conversions = conversion_table(plan, units);
  plan.packings = packing_table(scene);
  plan_estimate(plan);
  plan.limits = find_limits(plan);
  for (const Limit& limit : plan.limits) {
    if (limit.margin < 1) plan.warnings.push_back(warning_of(limit));
  }
  return plan;
}

}  // namespace rouleau::plan
