#include "models.hpp"

#include <algorithm>
#include <map>

#include "base/text.hpp"
#include "plugin/model.hpp"

namespace rouleau::plan {

namespace {

/// A demand on a model, by where it stands in a scene.
struct Demand {
  /// takes, gives: the input or output must be in its manifest. lacks: it must not, for nothing stands for it there.
  enum class What { takes, gives, lacks } what;
  std::string quantity;  ///< as in a manifest's needs and gives; "state": what it remembers
  std::string why;       ///< a clause: "the cells are more viscous than the fluid around them"
};

using What = Demand::What;

bool meets(const plugin::Manifest& manifest, const Demand& demand) {
  const bool there = demand.quantity == "state"   ? !manifest.state.empty()
                     : demand.what == What::gives ? manifest.gives_output(demand.quantity)
                                                  : manifest.needs_input(demand.quantity);
  return there == (demand.what != What::lacks);
}

std::string in_words(const Demand& demand) {
  const std::string because = ": " + demand.why;
  if (demand.what == What::takes) return "it does not take " + demand.quantity + because;
  if (demand.what == What::gives) return "it does not give " + demand.quantity + because;
  return (demand.quantity == "state" ? "it remembers something" : "it needs " + demand.quantity) + because;
}

/// What it takes that the fluid is driven; empty: it is not.
std::string what_drives(const scene::Scene& scene) {
  for (const scene::Stage& stage : scene.stages) {
    if (scene.fluid.body_force != scene::Vector()) return "fluid.body_force drives the fluid";
    if (stage.mean_velocity || stage.pressure_gradient != scene::Vector() || stage.oscillation.pressure_gradient != 0)
      return "a force drives the fluid in stage " + stage.name;
  }
  return {};
}

/// On the collision operator, by viscosities, membranes and what drives the fluid.
std::vector<Demand> demands_on_operator(const Models& models) {
  const scene::Scene& scene = *models.scene;
  std::vector<Demand> demands;
  const auto ask = [&](What what, const char* quantity, const std::string& why) {
    demands.push_back({what, quantity, why});
  };
  if (!scene.fluid.layers.empty())
    ask(What::takes, "relaxation_rate", "fluid.layers have other viscosities");
  else if (models.viscosity_contrast)
    ask(What::takes, "relaxation_rate", "inside of the cells the fluid has another viscosity");
  if (models.has_cells) {
    ask(What::takes, "force", "membranes act on the fluid");
    ask(What::gives, "velocity", "membranes move with the fluid");
  } else if (const std::string drives = what_drives(scene); !drives.empty()) {
    ask(What::takes, "force", drives);
  }
  return demands;
}

/// On the potential of an interaction, by what it acts between.
std::vector<Demand> demands_on(const scene::Interaction& interaction) {
  std::vector<Demand> demands;
  const auto lack = [&](std::initializer_list<const char*> quantities, const std::string& why) {
    for (const char* quantity : quantities) demands.push_back({What::lacks, quantity, why});
  };
  // What rubs on a wall would be part of its stress and power, which are those of the fluid.
  if (interaction.with_wall())
    lack({"tangential_velocity", "sliding_speed"}, "nothing rubs on a wall; it cannot act between cells and walls");
  if (interaction.with_self())
    lack({"state", "normal_velocity", "tangential_velocity", "sliding_speed"},
         "parts of one membrane meet by their distance alone; it cannot act within a membrane");
  return demands;
}

/// Throws Error(bad_input) at the model's place with all demands that it does not meet, and the models of the catalog
/// that meet all. Nothing for a model that was not found.
void require(const std::vector<Demand>& demands, const PlannedModel& model, const scene::Scene& scene,
             const plugin::Catalog& catalog) {
  if (model.manifest == nullptr) return;
  const auto all_met = [&](const plugin::Manifest& manifest) {
    return std::all_of(demands.begin(), demands.end(), [&](const Demand& demand) { return meets(manifest, demand); });
  };
  if (all_met(*model.manifest)) return;
  std::string problem = in_quotes(model.manifest->id) + " cannot be used here:";
  for (const Demand& demand : demands)
    if (!meets(*model.manifest, demand)) problem += "\n  " + in_words(demand);
  std::vector<std::string> others;
  for (const plugin::Manifest& manifest : catalog.manifests())
    if (manifest.kind == model.manifest->kind && manifest.works_in(scene.domain.dimension()) && all_met(manifest))
      others.push_back(manifest.id);
  std::sort(others.begin(), others.end());
  throw Error(Cause::bad_input, scene.place(model.pointer + "/model"), problem,
              {others.empty() ? "no model that was found can" : "take one that can: " + listed(others)});
}

/// Refuses a collision operator that does not work on the scene's lattice.
void require_lattice(const Models& models, const plugin::Catalog& catalog, Faults& faults) {
  const scene::Scene& scene = *models.scene;
  if (models.collision.manifest == nullptr || models.collision.manifest->works_in(scene.domain.dimension())) return;
  std::vector<std::string> others;
  for (const plugin::Manifest& manifest : catalog.manifests())
    if (manifest.kind == plugin::ModelKind::collision && manifest.works_in(scene.domain.dimension()))
      others.push_back(manifest.id);
  const scene::DimensionWords& words = scene.domain.words();
  faults.add(Error(Cause::bad_input, scene.place(models.collision.pointer + "/model"),
                   in_quotes(models.collision.manifest->id) + " does not work on " + words.lattice +
                       ", the lattice of " + words.number + " dimensions",
                   {"take one that does: " + listed(others)}));
}

/// Finds the models that the scene names, and resolves their parameters.
void find_models(Models& models, const plugin::Catalog& catalog, Faults& faults) {
  const scene::Scene& scene = *models.scene;
  const units::Units units;
  const auto planned = [&](plugin::ModelKind kind, const scene::ModelChoice& model) {
    PlannedModel result{nullptr, {}, model.pointer};
    if (model.model.empty()) return result;  // what was wrong with it has been said
    faults.attempt([&] {
      result.manifest = &catalog.find(kind, model.model, scene.place(model.pointer + "/model"),
                                      kind == plugin::ModelKind::collision ? 2 : scene.domain.dimension());
      result.parameters = plugin::resolve_parameters(model, *result.manifest, scene, units, faults);
    });
    return result;
  };
  models.collision = planned(plugin::ModelKind::collision, scene.fluid.collision);
  require_lattice(models, catalog, faults);
  for (const scene::CellType& type : scene.cell_types) {
    auto& laws = models.membranes.emplace_back();
    for (const scene::ModelChoice& law : type.membrane) laws.push_back(planned(plugin::ModelKind::membrane, law));
  }
  for (const scene::Interaction& interaction : scene.interactions) {
    PlannedModel model = planned(plugin::ModelKind::interaction, interaction.potential);
    if (!models.has_cells) model.parameters.inactive = true;
    faults.attempt([&] { require(demands_on(interaction), model, scene, catalog); });
    bool& has = interaction.with_wall()   ? models.has_wall_interactions
                : interaction.with_self() ? models.has_self_interactions
                                          : models.has_interactions;
    has = has || model.active();
    models.interactions.push_back(std::move(model));
  }
}

/// A stage makes its models anew where its units are its own, and has a row of the conversions for each of their
/// parameters.
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

plugin::ModelSetting setting_of(const Models& models, const scene::StageSetting& stage) {
  return {stage.units, 1 / stage.tau, models.scene->fluid.inertia, stage.dimension};
}

std::shared_ptr<const StageModels> made_for(const Models& models, const scene::StageSetting& stage) {
  const plugin::ModelSetting setting = setting_of(models, stage);
  StageModels made;
  Faults faults;
  const auto make = [&](const auto& maker, const PlannedModel& model, auto& result) {
    try {
      result = maker(*model.manifest, model.parameters.values, setting);
    } catch (const plugin::ModelRefused& refused) {
      faults.add({Cause::bad_input, models.scene->place(model.pointer),
                  in_quotes(model.manifest->id) + " cannot be made with these parameters: " + refused.reason() +
                      "\n  its manifest: " + model.manifest->file.string()});
    }
  };
  make(plugin::make_collision_operator, models.collision, made.collision);
  if (models.has_cells) {
    for (const std::vector<PlannedModel>& laws : models.membranes) {
      std::vector<core::MembraneLaw>& of_type = made.membranes.emplace_back();
      for (const PlannedModel& law : laws)
        if (law.active()) make(plugin::make_membrane_law, law, of_type.emplace_back());
    }
  }
  for (const PlannedModel& potential : models.interactions) {
    core::Potential& result = made.interactions.emplace_back();
    if (potential.active()) make(plugin::make_potential, potential, result);
  }
  faults.raise();
  return std::make_shared<const StageModels>(std::move(made));
}

}  // namespace

std::string Models::owner_of(const PlannedModel& model) const {
  const auto name = [&](int type) { return scene->cell_types[type].name; };
  for (std::size_t type = 0; type < membranes.size(); ++type) {
    for (const PlannedModel& law : membranes[type])
      if (&law == &model) return name(static_cast<int>(type));
  }
  for (std::size_t i = 0; i < interactions.size(); ++i) {
    if (&interactions[i] != &model) continue;
    const auto [a, b] = scene->names_of(scene->interactions[i]);
    return a + ", " + b;
  }
  return {};
}

std::vector<const PlannedModel*> Models::active_models() const {
  std::vector<const PlannedModel*> models{&collision};
  if (!has_cells) return models;
  for (std::size_t type = 0; type < membranes.size(); ++type) {
    const bool used = std::any_of(scene->cells.begin(), scene->cells.end(), [&](const scene::CellPlacement& cell) {
      return cell.type == static_cast<int>(type);
    });
    if (!used) continue;
    for (const PlannedModel& law : membranes[type])
      if (law.active()) models.push_back(&law);
  }
  for (const PlannedModel& potential : interactions)
    if (potential.active()) models.push_back(&potential);
  return models;
}

Models choose_models(const scene::Scene& scene, const plugin::Catalog& catalog, Faults& faults) {
  check_models_of_stages(scene);
  Models models{};
  models.scene = &scene;
  models.has_cells = !scene.cells.empty();
  find_models(models, catalog, faults);
  const bool layered = models.has_cells && !scene.fluid.layers.empty();
  models.viscosity_contrast =
      layered || std::any_of(scene.cells.begin(), scene.cells.end(), [&](const scene::CellPlacement& cell) {
        return scene.cell_types[cell.type].interior_viscosity != scene.fluid.viscosity;
      });
  for (int i = 0; i < static_cast<int>(scene.stages.size()); ++i)
    faults.attempt([&] { models.stages.push_back(scene::make_stage_setting(scene, i)); });
  faults.attempt([&] { require(demands_on_operator(models), models.collision, scene, catalog); });
  return models;
}

void make_models(Models& models) {
  std::map<double, std::shared_ptr<const StageModels>> by_density;  // which alone decides on a stage's units
  for (const scene::StageSetting& stage : models.stages) {
    std::shared_ptr<const StageModels>& made = by_density[stage.stage->density_factor];
    if (!made) made = made_for(models, stage);
    models.made.push_back(made);
  }
}

core::Potential make_potential(const Models& models, const PlannedModel& model, const std::vector<double>& values) {
  return plugin::make_potential(*model.manifest, values, setting_of(models, models.stages.front()));
}

void find_model_faults(const scene::Scene& scene, const plugin::Catalog& catalog, Faults& faults) {
  const std::size_t before = faults.size();
  faults.attempt([&] { check_models_of_stages(scene); });
  if (faults.size() > before) return;  // too many to look at
  Models models{};
  models.scene = &scene;
  find_models(models, catalog, faults);
}

}  // namespace rouleau::plan
