#include "plan_models.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "core/membrane/stiffness.hpp"
#include "plugin/handles.hpp"
#include "potential_shape.hpp"

namespace rouleau::plan {

namespace {

using Json = nlohmann::json;

constexpr units::Dimension surface_energy = units::dimension::tension;

WellInSi in_si(const std::optional<Well>& well, const units::LatticeUnits& units) {
  if (!well) return {};
  return {units.to_si(well->distance, units::dimension::length), units.to_si(well->depth, surface_energy),
          units.to_si(well->width(), units::dimension::length)};
}

Json well_json(const WellInSi& well) {
  return {{"zero_force_distance_m", well.distance}, {"depth_J_m2", well.depth}, {"width_m", well.width}};
}

/// The model's parameters with those exchanged at which it is the potential it stands for.
std::vector<double> what_it_stands_for(const PlannedModel& model) {
  std::vector<double> values = model.parameters.values;
  const plugin::Manifest& manifest = *model.manifest;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const plugin::Parameter& parameter = manifest.parameters[i];
    if (!manifest.stands_for.contains(parameter.name)) continue;
    const Json& value = manifest.stands_for[parameter.name];
    const auto& words = parameter.choices;
    values[i] =
        words.empty()
            ? value.get<double>() * units::Units().scale(parameter.unit)
            : static_cast<double>(std::find(words.begin(), words.end(), value.get<std::string>()) - words.begin());
  }
  return values;
}

}  // namespace

void to_json(Json& json, const InteractionWell& described) {
  json = well_json(described.well);
  json["model"] = described.model;
  json["between"] = described.between;
  if (described.stands_for) json["stands_for"] = well_json(*described.stands_for);
  if (described.widened) json["widened"] = *described.widened;
}

namespace {

/// Of an interaction without a well whose depth (a parameter with that role) is not 0; empty for any other.
std::string why_it_attracts_nowhere(const PlannedModel& model) {
  const auto value = [&](plugin::Role role) {
    const auto parameter = model.manifest->parameter_with(role);
    return parameter ? model.parameters.values[*parameter] : std::nan("");
  };
  if (!(value(plugin::Role::depth) > 0)) return "";
  const double cutoff = value(plugin::Role::cutoff), no_force = value(plugin::Role::zero_force_distance);
  if (!(cutoff <= no_force)) return "it attracts nowhere, though its depth is not 0";
  return "it attracts nowhere: its cutoff of " + number(cutoff * 1e6) +
         " um ends it before its force changes sign at " + number(no_force * 1e6) + " um; put the cutoff farther out";
}

}  // namespace

std::vector<InteractionWell> describe_wells(const Plan& plan) {
  std::vector<InteractionWell> wells;
  const scene::StageSetting& stage = plan.stages.front();
  const plugin::ModelSetting setting = model_setting(stage, plan.scene->fluid.inertia);
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    const PlannedModel& model = plan.interactions[i];
    if (!model.active() || !model.manifest->state.empty()) continue;  // what remembers has no one well
    const auto shape_at = [&](const std::vector<double>& values) {
      return find_shape(plugin::ModelInstance(*model.manifest, values, setting));
    };
    const PotentialShape shape = shape_at(model.parameters.values);
    InteractionWell& described = wells.emplace_back();
    described.model = model.manifest->id;
    described.between = plan.scene->names_of(plan.scene->interactions[i]);
    described.well = in_si(shape.well, stage.units);
    if (!shape.well) described.doubt = why_it_attracts_nowhere(model);
    const std::vector<double> meant =
        model.manifest->stands_for.is_object() ? what_it_stands_for(model) : model.parameters.values;
    if (meant == model.parameters.values) continue;
    const PotentialShape original = shape_at(meant);
    described.stands_for = in_si(original.well, stage.units);
    if (shape.well && original.well) described.widened = shape.well->width() / original.well->width();
  }
  return wells;
}

std::vector<std::array<std::string, 2>> attracting_types(const Plan& plan, const std::vector<InteractionWell>& wells) {
  std::vector<std::array<std::string, 2>> pairs;
  const auto add = [&](const std::array<std::string, 2>& between) {
    const auto is_cell = [](const std::string& name) { return name != scene::wall_name && name != scene::self_name; };
    if (is_cell(between[0]) && is_cell(between[1])) pairs.push_back(between);
  };
  for (const InteractionWell& described : wells) {
    if (described.well.attracts()) add(described.between);
  }
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    const PlannedModel& model = plan.interactions[i];
    if (model.active() && !model.manifest->state.empty()) add(plan.scene->names_of(plan.scene->interactions[i]));
  }
  return pairs;
}

double deepest_well(const Plan& plan, const std::vector<InteractionWell>& wells) {
  double deepest = std::nan("");
  for (const PlannedModel& model : plan.interactions) {
    if (plan.has_cells && model.manifest->state.empty()) deepest = 0;
  }
  for (const InteractionWell& described : wells) {
    if (described.well.attracts()) deepest = std::max(deepest, described.well.depth);
  }
  return deepest;
}

double shear_modulus(const Plan& plan) {
  if (!plan.has_cells) return std::nan("");
  double sum = 0;
  for (const PlannedModel& law : plan.membranes[plan.scene->cells.front().type]) {
    const auto parameter = law.manifest->parameter_with(plugin::Role::shear_modulus);
    if (parameter && law.active()) sum += law.parameters.values[*parameter];
  }
  return sum > 0 ? sum : std::nan("");
}

double stretching_modulus(const Plan& plan) {
  const scene::StageSetting& stage = plan.stages.front();
  double least = std::nan("");
  for (const std::vector<PlannedModel>& laws : plan.membranes) {
    double sum = 0;
    for (const PlannedModel& law : laws) {
      if (!law.active() || !law.manifest->gives_output("tension_by_stretch")) continue;
      sum += core::stretching_stiffness(plugin::make_membrane_law(*law.manifest, law.parameters.values,
                                                                  model_setting(stage, plan.scene->fluid.inertia)),
                                        {1.0});
    }
    if (sum > 0 && !(sum >= least)) least = stage.units.to_si(sum, units::dimension::tension);
  }
  return least;
}

}  // namespace rouleau::plan
