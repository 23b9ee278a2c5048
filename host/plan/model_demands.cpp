#include "model_demands.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "scene/driving_flow.hpp"

namespace rouleau::plan {

namespace {

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
    if (scene.fluid.body_force != Eigen::Vector2d::Zero() || scene.fluid.body_force_z != 0)
      return "fluid.body_force drives the fluid";
    if (stage.mean_velocity || stage.pressure_gradient.x() != 0 || stage.oscillation.pressure_gradient != 0)
      return "a force drives the fluid in stage " + stage.name;
  }
  return {};
}

}  // namespace

std::vector<Demand> demands_on_operator(const Plan& plan) {
  const scene::Scene& scene = *plan.scene;
  std::vector<Demand> demands;
  const auto ask = [&](What what, const char* quantity, const std::string& why) {
    demands.push_back({what, quantity, why});
  };
  if (!scene.fluid.layers.empty()) {
    ask(What::takes, "relaxation_rate", "fluid.layers have other viscosities");
  } else if (plan.viscosity_contrast) {
    ask(What::takes, "relaxation_rate", "inside of the cells the fluid has another viscosity");
  }
  if (plan.has_cells) {
    ask(What::takes, "force", "membranes act on the fluid");
    ask(What::gives, "velocity", "membranes move with the fluid");
  } else if (const std::string drives = what_drives(scene); !drives.empty()) {
    ask(What::takes, "force", drives);
  }
  return demands;
}

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

void require(const std::vector<Demand>& demands, const PlannedModel& model, const scene::Scene& scene,
             const plugin::Catalog& catalog) {
  if (model.manifest == nullptr) return;
  const auto all_met = [&](const plugin::Manifest& manifest) {
    return std::all_of(demands.begin(), demands.end(), [&](const Demand& demand) { return meets(manifest, demand); });
  };
  if (all_met(*model.manifest)) return;
  std::string problem = in_quotes(model.manifest->id) + " cannot be used here:";
  for (const Demand& demand : demands) {
    if (!meets(*model.manifest, demand)) problem += "\n  " + in_words(demand);
  }
  std::vector<std::string> others;
  for (const plugin::Manifest& manifest : catalog.manifests()) {
    if (manifest.kind == model.manifest->kind && manifest.works_in(scene.domain.dimension()) && all_met(manifest))
      others.push_back(manifest.id);
  }
  std::sort(others.begin(), others.end());
  throw Error(Cause::bad_input, scene.place(model.pointer + "/model"), problem,
              {others.empty() ? "no model that was found can" : "take one that can: " + listed(others)});
}

}  // namespace rouleau::plan
