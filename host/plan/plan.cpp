#include "plan.hpp"

#include <algorithm>
#include <set>

#include "base/text.hpp"
#include "model_demands.hpp"
#include "plugin/model.hpp"
#include "stability_limits.hpp"

namespace rouleau::plan {

namespace {

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

void check_developed_flows(const Plan& plan) {
  const scene::Domain& domain = plan.scene->domain;
  for (const scene::StageSetting& stage : plan.stages) {
    if (stage.stage->start != scene::WallStart::developed || stage.largest_drive(domain) == 0) continue;
    const auto refuse = [&](const char* why) {
      throw Error(Cause::bad_input, plan.scene->place(stage.stage->pointer + "/start"), why);
    };
    if (!scene::has_walls(domain))
      refuse("\"developed\" wants walls: a driven flow that no wall holds never becomes steady; leave start out");
    if (domain.periodic_y || stage.largest_drive(domain) != stage.largest_body_force_x())
      refuse(
          "\"developed\" is known of a flow along x between walls across y alone; leave start out, or turn the scene "
          "so that the force acts along x");
  }
}

/// A stage that ends by energy needs models that tell theirs.
void check_equilibria(const Plan& plan) {
  const auto stage = std::find_if(plan.stages.begin(), plan.stages.end(),
                                  [](const scene::StageSetting& s) { return s.stage->until_equilibrium; });
  if (stage == plan.stages.end()) return;
  const auto refuse = [&](const PlannedModel& model) {
    throw Error(Cause::bad_input, plan.scene->place(stage->stage->pointer + "/until"),
                "\"equilibrium\" needs the energy of all cells, and " + model.manifest->id + " gives none",
                {"end the stage by \"at_rest\" or by duration"});
  };
  for (const PlannedModel& model : plan.interactions) {
    if (model.active() && !model.manifest->gives_output("energy")) refuse(model);
  }
  for (const std::vector<PlannedModel>& laws : plan.membranes) {
    for (const PlannedModel& law : laws) {
      // A law that only resists the rate of stretch stores nothing.
      const bool tells = law.manifest->gives_output("energy") || law.manifest->gives_output("tension_by_rate");
      if (law.active() && !tells) refuse(law);
    }
  }
}

/// Makes every active model once.
void try_models(const Plan& plan) {
  const plugin::ModelSetting setting = model_setting(plan.stages.front(), plan.scene->fluid.inertia);
  Faults faults;
  for (const PlannedModel* model : plan.active_models()) {
    try {
      const plugin::ModelInstance instance(*model->manifest, model->parameters.values, setting);
    } catch (const plugin::ModelRefused& refused) {
      faults.add({Cause::bad_input, plan.scene->place(model->pointer),
                  in_quotes(model->manifest->id) + " cannot be made with these parameters: " + refused.reason() +
                      "\n  its manifest: " + model->manifest->file.string()});
    }
  }
  faults.raise();
}

void choose_coupling(Plan& plan) {
  const std::string& wanted = plan.scene->numerics.coupling;
  if (!plan.has_cells) {
    plan.coupling = "none: the scene has no cells";
    return;
  }
  if (wanted != "auto") {
    plan.semi_implicit = wanted == "semi-implicit";
    plan.coupling = wanted + ", as numerics.coupling says";
    return;
  }
  if (!plan.scene->fluid.layers.empty()) {
    plan.coupling =
        "explicit, chosen by \"auto\": the semi-implicit step knows of one viscosity around the cells, and "
        "fluid.layers has others";
    return;
  }
  const double margin = explicit_margin(plan);
  const bool stiff = margin < comfortable_margin;
  plan.semi_implicit = stiff && semi_implicit_gains(plan);
  plan.coupling =
      std::string(plan.semi_implicit ? "semi-implicit" : "explicit") +
      ", chosen by \"auto\": the explicit limit of the membranes' stiffness is " + number(margin, 3) +
      " times what they have, " + (stiff ? "below " : "at least ") + number(comfortable_margin, 2) +
      (stiff && !plan.semi_implicit ? "; with this numerics.tau and kernel the semi-implicit step would not help" : "");
}

}  // namespace

std::string Plan::owner_of(const PlannedModel& model) const {
  const auto name = [&](int type) { return scene->cell_types[type].name; };
  for (std::size_t type = 0; type < membranes.size(); ++type) {
    for (const PlannedModel& law : membranes[type]) {
      if (&law == &model) return name(static_cast<int>(type));
    }
  }
  for (std::size_t i = 0; i < interactions.size(); ++i) {
    if (&interactions[i] != &model) continue;
    const auto [a, b] = scene->names_of(scene->interactions[i]);
    return a + ", " + b;
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

namespace {

/// Finds the models that the scene names, and resolves their parameters.
void plan_models(Plan& plan, const plugin::Catalog& catalog, Faults& faults) {
  const scene::Scene& scene = *plan.scene;
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
  plan.collision = planned(plugin::ModelKind::collision, scene.fluid.collision);
  if (plan.collision.manifest != nullptr && !plan.collision.manifest->works_in(scene.domain.dimension())) {
    std::vector<std::string> others;
    for (const plugin::Manifest& manifest : catalog.manifests()) {
      if (manifest.kind == plugin::ModelKind::collision && manifest.works_in(scene.domain.dimension()))
        others.push_back(manifest.id);
    }
    const bool space = scene.domain.depth.has_value();
    faults.add(Error(Cause::bad_input, scene.place(plan.collision.pointer + "/model"),
                     in_quotes(plan.collision.manifest->id) + " does not work on " +
                         (space ? "D3Q19, the lattice of three dimensions" : "D2Q9, the lattice of two dimensions"),
                     {"take one that does: " + listed(others)}));
  }
  for (const scene::CellType& type : scene.cell_types) {
    auto& laws = plan.membranes.emplace_back();
    for (const scene::ModelChoice& law : type.membrane) laws.push_back(planned(plugin::ModelKind::membrane, law));
  }
  for (const scene::Interaction& interaction : scene.interactions) {
    PlannedModel model = planned(plugin::ModelKind::interaction, interaction.potential);
    if (!plan.has_cells) model.parameters.inactive = true;
    faults.attempt([&] { require(demands_on(interaction), model, scene, catalog); });
    bool& has = interaction.with_wall()   ? plan.has_wall_interactions
                : interaction.with_self() ? plan.has_self_interactions
                                          : plan.has_interactions;
    has = has || model.active();
    plan.interactions.push_back(std::move(model));
  }
}

}  // namespace

void find_model_faults(const scene::Scene& scene, const plugin::Catalog& catalog, Faults& faults) {
  const std::size_t before = faults.size();
  faults.attempt([&] { check_models_of_stages(scene); });
  if (faults.size() > before) return;  // too many to look at
  Plan plan{};
  plan.scene = &scene;
  plan_models(plan, catalog, faults);
}

Plan make_plan(const scene::Scene& scene, const plugin::Catalog& catalog, std::optional<NumericsChoice> choice) {
  check_models_of_stages(scene);
  Plan plan{};
  plan.scene = &scene;
  plan.numerics_choice = std::move(choice);
  plan.has_cells = !scene.cells.empty();
  if (catalog.lock()) plan.lock = {catalog.lock()->file.string(), catalog.lock()->sha256};
  Faults faults;
  plan_models(plan, catalog, faults);
  const bool layered = plan.has_cells && !scene.fluid.layers.empty();
  plan.viscosity_contrast =
      layered || std::any_of(scene.cells.begin(), scene.cells.end(), [&](const scene::CellPlacement& cell) {
        return scene.cell_types[cell.type].interior_viscosity != scene.fluid.viscosity;
      });
  for (int i = 0; i < static_cast<int>(scene.stages.size()); ++i) {
    faults.attempt([&] { plan.stages.push_back(scene::make_stage_setting(scene, i)); });
  }
  faults.attempt([&] { require(demands_on_operator(plan), plan.collision, scene, catalog); });
  faults.attempt([&] { check_developed_flows(plan); });
  faults.attempt([&] { check_equilibria(plan); });
  faults.raise();
  choose_coupling(plan);
  try_models(plan);
  return plan;
}

std::vector<std::string> code_of_the_scene(const Plan& plan) {
  if (!plugin::scenes_may_bring_plugins()) return {};
  const std::vector<std::filesystem::path>& folders = plan.scene->plugin_dirs;
  std::set<std::string> known;
  std::vector<std::string> sentences;
  for (const PlannedModel* model : plan.active_models()) {
    const plugin::Manifest& manifest = *model->manifest;
    const auto folder = std::find_if(folders.begin(), folders.end(),
                                     [&](const auto& each) { return plugin::is_below(manifest.file, each); });
    if (folder == folders.end() || !known.insert(manifest.id).second) continue;
    const std::string pointer = "/plugin_dirs/" + std::to_string(folder - folders.begin());
    const std::string written = plan.scene->document->root().at(nlohmann::json::json_pointer(pointer));
    sentences.push_back("the scene brings code along, which runs with your rights: the model " +
                        in_quotes(manifest.id) + ", library " + manifest.library.string() + ", from its plugin_dirs (" +
                        pointer + ' ' + in_quotes(written) +
                        "); with ROULEAU_SCENE_PLUGINS=no in the environment such folders are left out");
  }
  return sentences;
}

}  // namespace rouleau::plan
