// What a scene will compute: models, stages and the step of the membranes, decided before the first step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/faults.hpp"
#include "numerics_auto.hpp"
#include "plugin/catalog.hpp"
#include "plugin/lock.hpp"
#include "plugin/model_setup.hpp"
#include "plugin/parameters.hpp"
#include "scene/lattice.hpp"
#include "scene/stage_scales.hpp"

namespace rouleau::plan {

using scene::lattice_domain, scene::lattice_spacing, scene::StageSetting;

/// What the models of a stage are told about the lattice.
inline plugin::ModelSetting model_setting(const scene::StageSetting& stage, bool inertia) {
  return {stage.units, 1 / stage.tau, inertia, stage.dimension};
}

/// A model the scene names, with its parameters. An inactive one is left out: its library is not opened.
struct PlannedModel {
  const plugin::Manifest* manifest;
  plugin::ParameterValues parameters;
  std::string pointer;  ///< its place in the scene
  [[nodiscard]] bool active() const { return !parameters.inactive; }
};

/// All that a run needs. What it will cost, what is left out and what to be wary of is in a PlanReport.
struct Plan {
  const scene::Scene* scene;
  std::optional<NumericsChoice> numerics_choice;  ///< none where the scene pins all of its numerics
  PlannedModel collision;
  std::vector<std::vector<PlannedModel>> membranes;  ///< for each cell type
  std::vector<PlannedModel> interactions;            ///< in the order of Scene::interactions
  std::vector<scene::StageSetting> stages;
  bool has_cells = false;
  bool viscosity_contrast = false;
  bool has_interactions = false;       ///< between cells
  bool has_wall_interactions = false;  ///< between cells and walls
  bool has_self_interactions = false;  ///< between parts of one membrane
  bool semi_implicit = false;  ///< membranes: the step that numerics.coupling names or, if "auto", the limits ask for
  std::string coupling;        ///< which step that is and why, for people
  std::optional<plugin::LockUse> lock;  ///< the lock that the plugins were held against

  /// Models whose libraries the run opens.
  [[nodiscard]] std::vector<const PlannedModel*> active_models() const;
  /// The cell type of a law, the two types of an interaction ("rbc, platelet"); empty for the fluid's model.
  [[nodiscard]] std::string owner_of(const PlannedModel& model) const;
};

/// A sentence for each library that lies in a folder of the scene's own plugin_dirs: code that comes with the scene.
std::vector<std::string> code_of_the_scene(const Plan& plan);

/// Adds what is wrong with the models that a scene names, known or unknown, and their parameters. The scene may be one that
/// could not be read whole; `faults` has why.
void find_model_faults(const scene::Scene& scene, const plugin::Catalog& catalog, Faults& faults);

/// Makes every active model once, so that a plan never promises a run that cannot start. Throws Error(bad_input) with
/// the place in the scene of what cannot be computed or a model refuses, Error(plugin_refused) for a library that is
/// refused. The scene and the catalog must outlive the plan; `choice` is what read_within_limits() has put into the
/// scene.
Plan make_plan(const scene::Scene& scene, const plugin::Catalog& catalog, std::optional<NumericsChoice> choice = {});

}  // namespace rouleau::plan
