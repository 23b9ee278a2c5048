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

Json describe(const std::optional<Well>& well, const units::LatticeUnits& units) {
  if (!well) return {{"zero_force_distance_m", nullptr}, {"depth_J_m2", nullptr}, {"width_m", nullptr}};
  return {{"zero_force_distance_m", units.to_si(well->distance, units::dimension::length)},
          {"depth_J_m2", units.to_si(well->depth, surface_energy)},
          {"width_m", units.to_si(well->width(), units::dimension::length)}};
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

void try_models(const Plan& plan) {
  const plugin::ModelSetting setting = plan.stages.front().model_setting(plan.scene->fluid.inertia);
  for (const PlannedModel* model : plan.active_models()) {
    try {
      const plugin::ModelInstance instance(*model->manifest, model->parameters.values, setting);
    } catch (const plugin::ModelRefused& refused) {
      throw Error(Cause::bad_input, plan.scene->place(model->pointer),
                  in_quotes(model->manifest->id) + " cannot be made with these parameters: " + refused.reason() +
                      "\n  its manifest: " + model->manifest->file.string());
    }
  }
}

Json describe_wells(const Plan& plan) {
  Json wells = Json::array();
  const StageSetting& stage = plan.stages.front();
  const plugin::ModelSetting setting = stage.model_setting(plan.scene->fluid.inertia);
  for (std::size_t i = 0; i < plan.interactions.size(); ++i) {
    const PlannedModel& model = plan.interactions[i];
    if (!model.active() || !model.manifest->state.empty()) continue;  // what remembers has no one well
    const auto shape_at = [&](const std::vector<double>& values) {
      return find_shape(plugin::ModelInstance(*model.manifest, values, setting));
    };
    const PotentialShape shape = shape_at(model.parameters.values);
    Json entry = describe(shape.well, stage.units);
    entry["model"] = model.manifest->id;
    for (const int type : plan.scene->interactions[i].between) {
      entry["between"].push_back(plan.scene->cell_types[static_cast<std::size_t>(type)].name);
    }
    const std::vector<double> meant =
        model.manifest->stands_for.is_object() ? what_it_stands_for(model) : model.parameters.values;
    if (meant != model.parameters.values) {
      const PotentialShape original = shape_at(meant);
      entry["stands_for"] = describe(original.well, stage.units);
      if (shape.well && original.well) entry["widened"] = shape.well->width() / original.well->width();
    }
    wells.push_back(std::move(entry));
  }
  return wells;
}

double deepest_well(const Plan& plan) {
  double deepest = std::nan("");
  for (const PlannedModel& model : plan.interactions) {
    if (plan.has_cells && model.manifest->state.empty()) deepest = 0;
  }
  for (const Json& well : plan.wells) {
    if (well["depth_J_m2"].is_number()) deepest = std::max(deepest, well["depth_J_m2"].get<double>());
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
  const StageSetting& stage = plan.stages.front();
  double least = std::nan("");
  for (const std::vector<PlannedModel>& laws : plan.membranes) {
    double sum = 0;
    for (const PlannedModel& law : laws) {
      if (!law.active() || !law.manifest->gives_output("tension_by_stretch")) continue;
      sum += core::stretching_stiffness(plugin::make_membrane_law(*law.manifest, law.parameters.values,
                                                                  stage.model_setting(plan.scene->fluid.inertia)),
                                        {1.0});
    }
    if (sum > 0 && !(sum >= least)) least = stage.units.to_si(sum, units::dimension::tension);
  }
  return least;
}

}  // namespace rouleau::plan
