#include "plan.hpp"

#include <algorithm>
#include <set>

#include "base/text.hpp"
#include "constants.hpp"
#include "scene/driving_flow.hpp"

namespace rouleau::plan {

namespace {

void check_developed_flows(const Models& models) {
  const scene::Domain& domain = models.scene->domain;
  for (const scene::StageSetting& stage : models.stages) {
    if (stage.stage->start != scene::WallStart::developed || stage.largest_drive(domain) == 0) continue;
    const auto refuse = [&](const char* why) {
      throw Error(Cause::bad_input, models.scene->place(stage.stage->pointer + "/start"), why);
    };
    if (!scene::has_walls(domain))
      refuse("\"developed\" wants walls: a driven flow that no wall holds never becomes steady; leave start out");
    if (!domain.walled(1) || stage.largest_drive(domain) != stage.largest_body_force().x())
      refuse(
          "\"developed\" is known of a flow along x between walls across y alone; leave start out, or turn the scene "
          "so that the force acts along x");
  }
}

/// A stage that ends by energy needs models that tell theirs.
void check_equilibria(const Models& models) {
  const auto stage = std::find_if(models.stages.begin(), models.stages.end(),
                                  [](const scene::StageSetting& s) { return s.stage->until_equilibrium; });
  if (stage == models.stages.end()) return;
  const auto refuse = [&](const PlannedModel& model) {
    throw Error(Cause::bad_input, models.scene->place(stage->stage->pointer + "/until"),
                "\"equilibrium\" needs the energy of all cells, and " + model.manifest->id + " gives none",
                {"end the stage by \"at_rest\" or by duration"});
  };
  for (const PlannedModel& model : models.interactions) {
    if (model.manifest != nullptr && model.active() && !model.manifest->gives_output("energy")) refuse(model);
  }
  for (const std::vector<PlannedModel>& laws : models.membranes) {
    for (const PlannedModel& law : laws) {
      if (law.manifest == nullptr) continue;  // that has been said
      // A law that only resists the rate of stretch stores nothing.
      const auto gives = [&](const char* output) { return law.manifest->gives_output(output); };
      const bool tells =
          gives("energy") || gives("tension_by_rate") || gives("shear_viscosity") || gives("area_viscosity");
      if (law.active() && !tells) refuse(law);
    }
  }
}

/// A stage that ends once cells have parted needs a well that joins them.
void check_partings(const Plan& plan) {
  const auto stage = std::find_if(plan.stages.begin(), plan.stages.end(),
                                  [](const scene::StageSetting& s) { return s.stage->until_parted; });
  if (stage == plan.stages.end() || !attracting_types(plan, plan.facts.wells).empty()) return;
  throw Error(Cause::bad_input, plan.scene->place(stage->stage->pointer + "/until"),
              "\"parted\" never comes, since no interaction attracts the cells to each other",
              {"add an interaction with a well between two cell types, or leave until out"});
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
  const double margin = explicit_margin(plan.facts);
  const bool stiff = margin < comfortable_margin;
  plan.semi_implicit = stiff && semi_implicit_gains(*plan.scene);
  plan.coupling =
      std::string(plan.semi_implicit ? "semi-implicit" : "explicit") +
      ", chosen by \"auto\": the explicit limit of the membranes' stiffness is " + number(margin, 3) +
      " times what they have, " + (stiff ? "below " : "at least ") + number(comfortable_margin, 2) +
      (stiff && !plan.semi_implicit ? "; with this numerics.tau and kernel the semi-implicit step would not help" : "");
}

}  // namespace

bool semi_implicit_gains(const scene::Scene& scene) {
  return scene.numerics.tau >= kernel_named(scene.numerics.kernel).semi_implicit_from;
}

Plan make_plan(const scene::Scene& scene, const plugin::Catalog& catalog, std::optional<NumericsChoice> choice) {
  Faults faults;
  Plan plan{choose_models(scene, catalog, faults)};
  plan.numerics_choice = std::move(choice);
  if (catalog.lock()) plan.lock = {catalog.lock()->file.string(), catalog.lock()->sha256};
  faults.attempt([&] { check_developed_flows(plan); });
  faults.attempt([&] { check_equilibria(plan); });
  faults.raise();
  make_models(plan);
  plan.facts = find_facts(plan);
  check_partings(plan);
  choose_coupling(plan);
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
