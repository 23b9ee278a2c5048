#include "facts.hpp"

#include <algorithm>
#include <map>

#include "base/text.hpp"
#include "core/coupling/slip_constants.hpp"
#include "core/fluid/relaxation.hpp"
#include "core/membrane/node_mobility.hpp"
#include "core/membrane/semi_implicit_filter.hpp"
#include "core/surface/surface_filter.hpp"
#include "core/surface/surface_viscosity.hpp"
#include "scene/driving_flow.hpp"
#include "shape/extent.hpp"

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

/// Facts of the potentials.
std::vector<InteractionWell> wells_of(const Models& models, const ModelFacts& facts) {
  std::vector<InteractionWell> wells;
  const units::LatticeUnits& units = models.stages.front().units;
  for (std::size_t i = 0; i < models.interactions.size(); ++i) {
    if (!facts.potentials[i]) continue;
    const PlannedModel& model = models.interactions[i];
    const PotentialShape& shape = *facts.potentials[i];
    InteractionWell& described = wells.emplace_back();
    described.model = model.manifest->id;
    described.between = models.scene->names_of(models.scene->interactions[i]);
    described.well = in_si(shape.well, units);
    if (!shape.well) described.doubt = why_it_attracts_nowhere(model);
    if (!model.manifest->stands_for.is_object()) continue;
    const std::vector<double> meant = what_it_stands_for(model);
    if (meant == model.parameters.values) continue;
    const PotentialShape original = find_shape(make_potential(models, model, meant));
    described.stands_for = in_si(original.well, units);
    if (shape.well && original.well) described.widened = shape.well->width() / original.well->width();
  }
  return wells;
}

/// Limit of a membrane between two fluids: the geometric mean of those at either side's relaxation time. Measured at
/// tau 1 and ratio 5: 0.83 and 0.63 of the limits at ratio 1, by this rule 0.83 and 0.63. A cell may come into every
/// layer, so that the lowest counts.
double limit_between(std::span<const AtTau> table, const scene::Scene& scene, double interior_viscosity) {
  double outside = interpolate(table, scene.numerics.tau);
  for (const scene::FluidLayer& layer : scene.fluid.layers)
    outside = std::min(outside, interpolate(table, relaxation_time_of(layer.viscosity, scene)));
  return std::sqrt(outside * interpolate(table, relaxation_time_of(interior_viscosity, scene)));
}

MembraneFacts membrane_facts(const Models& models, std::size_t type, const scene::StageSetting& stage,
                             const StageModels& made, const TypeFacts& of_type) {
  MembraneFacts facts;
  const scene::CellType& cell = models.scene->cell_types[type];
  const scene::Shape& shape = cell.shape;
  if (cell.stress_free && models.has_cells) {
    const int dimension = models.scene->domain.dimension();
    facts.first = shape::first_stretch(cell, made.membranes[type], stage.units, dimension);
    facts.tension = stage.units.to_lattice(facts.first->tension, units::dimension::tension);
  }
  const auto* circle = std::get_if<scene::Circle>(&shape);
  const auto* sphere = std::get_if<scene::Sphere>(&shape);
  double at_rest = 0;
  std::size_t next = 0;
  for (const PlannedModel& planned : models.membranes[type]) {
    if (!planned.active()) continue;
    const core::MembraneLaw& law = made.membranes[type][next++];
    facts.stiffness += law;
    if (facts.first)
      facts.stiffness.stretching +=
          std::max(0.0, core::stretching_stiffness(law, {facts.first->least, facts.first->most}) -
                            core::stretching_stiffness(law));
    const double stretching = core::stretching_stiffness(law, {1.0});
    at_rest += stretching;
    if (planned.manifest->gives_output("tension_by_stretch")) facts.elastic_modulus += stretching;
    if (circle != nullptr) facts.tension += core::tension_at(law, circle->prestretch);
    if (sphere != nullptr) facts.tension += core::tension_at(law, sphere->prestretch);
  }
  facts.recovery_rate =
      at_rest / (3 * core::viscosity_of(stage.tau) * (of_type.radius / stage.units.length) * stage.units.time);
  return facts;
}

/// Of a cell type in a stage, what limits it: the stretching and the bending stiffness that are nearest to their
/// limits, and the longest mean.
void add_coupling(const Models& models, std::size_t type, double spacing, const TypeFacts& of_type, ModelFacts& facts) {
  const scene::Scene& scene = *models.scene;
  const scene::CellType& cell = scene.cell_types[type];
  const KernelFacts& kernel = kernel_named(scene.numerics.kernel);
  const core::Stiffness& stiffness = facts.membranes[type].stiffness;
  const double ratio = cell.interior_viscosity / scene.fluid.viscosity;
  const double length = of_type.node_spacing / spacing;
  core::SlipConstants slip{0, 0};
  if (scene.numerics.slip_correction) slip = core::slip_constants(kernel.kind, ratio, scene.domain.dimension());
  const double factor = core::stiffening(slip.shift, length), viscosity = core::viscosity_of(scene.numerics.tau);
  facts.stretching.narrow({factor * stiffness.stretching,
                           kernel.stretch_limit * limit_between(stretch_limit, scene, cell.interior_viscosity)});
  facts.bending.narrow({factor * stiffness.bending,
                        kernel.bending_limit * limit_between(bending_limit, scene, cell.interior_viscosity)});
  if (scene.domain.dimension() == 3) {
    const core::KernelResponse response = core::kernel_response(kernel.kind, slip.shift);
    const double eigenvalue = core::largest_eigenvalue(response, stiffness.stretching, stiffness.bending);
    facts.viscous_lag = std::max(facts.viscous_lag, stiffness.viscosity / core::viscous_modulus(viscosity, response));
    facts.steps_of_mean = std::max(facts.steps_of_mean, core::steps_of_mean(eigenvalue, viscosity));
  } else if (scene.numerics.slip_correction && !std::holds_alternative<scene::Circle>(cell.shape)) {
    const double over_radius = length * spacing / of_type.radius;
    facts.slip_smoothing = std::max(
        facts.slip_smoothing, over_radius * over_radius / 2 *
                                  core::outline_slip_smoothings(length, slip.slip / viscosity, stiffness.stretching));
  }
}

ModelFacts model_facts(const Models& models, const scene::StageSetting& stage, const std::vector<TypeFacts>& types) {
  const StageModels& made = *models.made[stage.index];
  ModelFacts facts;
  for (std::size_t type = 0; type < made.membranes.size(); ++type) {
    facts.membranes.push_back(membrane_facts(models, type, stage, made, types[type]));
    add_coupling(models, type, stage.units.length, types[type], facts);
    facts.prestress_compression =
        std::max(facts.prestress_compression, compression_by_pressure * std::abs(facts.membranes[type].tension) *
                                                  (models.scene->domain.dimension() - 1) * stage.units.length /
                                                  types[type].radius);
  }
  for (std::size_t i = 0; i < models.interactions.size(); ++i) {
    const PlannedModel& model = models.interactions[i];
    std::optional<PotentialShape>& shape = facts.potentials.emplace_back();
    if (!model.active()) continue;
    const core::Potential& potential = made.interactions[i];
    if (!model.remembers()) shape = find_shape(potential);
    if (!models.scene->interactions[i].with_wall())
      facts.cutoff = std::max(facts.cutoff, potential.table->cutoff(potential.self.get()));
  }
  return facts;
}

}  // namespace

void to_json(Json& json, const InteractionWell& described) {
  json = well_json(described.well);
  json["model"] = described.model;
  json["between"] = described.between;
  if (described.stands_for) json["stands_for"] = well_json(*described.stands_for);
  if (described.widened) json["widened"] = *described.widened;
}

Facts find_facts(const Models& models) {
  const scene::Scene& scene = *models.scene;
  Facts facts;
  for (const scene::CellType& type : scene.cell_types)
    facts.types.push_back({shape::shape_radius(type.shape), shape::node_spacing(type)});
  std::map<const StageModels*, std::shared_ptr<const ModelFacts>> known;
  for (const scene::StageSetting& stage : models.stages) {
    std::shared_ptr<const ModelFacts>& of_models = known[models.made[stage.index].get()];
    if (!of_models) of_models = std::make_shared<const ModelFacts>(model_facts(models, stage, facts.types));
    const double rate = scene::mean_shear_rate(*stage.stage, scene);
    facts.stages.push_back({.models = of_models,
                            .shear_rate = rate,
                            .strain = static_cast<double>(stage.max_steps) * stage.units.time * rate,
                            .start = flow_start(scene, stage.index),
                            .travel = cell_travel(scene, stage),
                            .follows_cells = follows_cells(scene, stage)});
  }
  facts.wells = wells_of(models, *facts.stages.front().models);
  return facts;
}

double interpolate(std::span<const AtTau> table, double tau) {
  if (tau <= table.front().tau) return table.front().value;
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (tau > table[i].tau) continue;
    const double t =
        std::log((tau - 0.5) / (table[i - 1].tau - 0.5)) / std::log((table[i].tau - 0.5) / (table[i - 1].tau - 0.5));
    return std::exp((1 - t) * std::log(table[i - 1].value) + t * std::log(table[i].value));
  }
  return table.back().value;
}

double relaxation_time_of(double viscosity, const scene::Scene& scene) {
  return core::relaxation_time_of(viscosity / scene.fluid.viscosity * core::viscosity_of(scene.numerics.tau));
}

double explicit_margin(const Facts& facts) {
  double margin = std::numeric_limits<double>::infinity();
  for (const StageFacts& stage : facts.stages)
    margin = std::min({margin, stage.models->stretching.margin(), stage.models->bending.margin()});
  return margin;
}

std::optional<RecoveryRates> recovery_rates(const Models& models, const Facts& facts) {
  if (!models.has_cells) return std::nullopt;
  RecoveryRates rates{INFINITY, 0};
  const double share = shear_share[models.scene->domain.dimension() - 2];
  for (const MembraneFacts& membrane : facts.stages.front().models->membranes) {
    const double rate = share * membrane.recovery_rate;
    rates = {std::min(rates.least, rate), std::max(rates.most, rate)};
  }
  return rates;
}

scene::Attractions attracting_types(const Models& models, const std::vector<InteractionWell>& wells) {
  scene::Attractions attracting;
  const auto add = [&](std::array<std::string, 2> between, double depth) {
    if (between[1] == scene::wall_name || between[1] == scene::self_name) return;
    std::sort(between.begin(), between.end());
    attracting[between] += depth;
  };
  for (const InteractionWell& described : wells) {
    const bool tells = std::none_of(models.interactions.begin(), models.interactions.end(), [&](const auto& model) {
      return model.manifest->id == described.model && !model.manifest->gives_output("energy");
    });
    if (described.well.attracts()) add(described.between, tells ? described.well.depth : std::nan(""));
  }
  for (std::size_t i = 0; i < models.interactions.size(); ++i)
    if (const PlannedModel& model = models.interactions[i]; model.active() && model.remembers())
      add(models.scene->names_of(models.scene->interactions[i]), std::nan(""));
  return attracting;
}

double deepest_well(const Models& models, const std::vector<InteractionWell>& wells) {
  double deepest = std::nan("");
  for (const PlannedModel& model : models.interactions)
    if (models.has_cells && !model.remembers()) deepest = 0;
  for (const InteractionWell& described : wells)
    if (described.well.attracts()) deepest = std::max(deepest, described.well.depth);
  return deepest;
}

double depth_over_bending(const Models& models, const Facts& facts, const scene::StageSetting& stage,
                          const scene::Interaction& interaction, double depth) {
  double most = 0;
  for (const int type : interaction.between) {
    bool kept_apart = false;
    for (std::size_t i = 0; i < models.interactions.size(); ++i) {
      const scene::Interaction& other = models.scene->interactions[i];
      kept_apart = kept_apart || (other.with_self() && other.between[0] == type && models.interactions[i].active());
    }
    const double bending = facts.stages[stage.index].models->membranes[type].stiffness.bending;
    const double radius = facts.types[type].radius / stage.units.length;
    if (!kept_apart && bending > 0) most = std::max(most, depth * radius * radius / bending);
  }
  return most;
}

double shear_modulus(const Models& models) {
  if (!models.has_cells) return std::nan("");
  double sum = 0;
  for (const PlannedModel& law : models.membranes[models.scene->cells.front().type]) {
    const auto parameter = law.manifest->parameter_with(plugin::Role::shear_modulus);
    if (parameter && law.active()) sum += law.parameters.values[*parameter];
  }
  return sum > 0 ? sum : std::nan("");
}

double stretching_modulus(const Models& models, const Facts& facts) {
  double least = std::nan("");
  for (const MembraneFacts& membrane : facts.stages.front().models->membranes) {
    const double modulus = membrane.elastic_modulus;
    if (modulus > 0 && !(modulus >= least))
      least = models.stages.front().units.to_si(modulus, units::dimension::tension);
  }
  return least;
}

}  // namespace rouleau::plan
