// The models that a scene names: chosen from a catalog, held against what the scene asks of them, made once for each
// stage.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "core/model/model.hpp"
#include "plugin/catalog.hpp"
#include "plugin/parameters.hpp"
#include "scene/stage_scales.hpp"

namespace rouleau::plan {

/// A model the scene names, with its parameters. An inactive one is left out: its library is not opened.
struct PlannedModel {
  const plugin::Manifest* manifest;
  plugin::ParameterValues parameters;
  std::string pointer;  ///< its place in the scene
  [[nodiscard]] bool active() const { return !parameters.inactive; }
  /// Bonds and the like: what such a potential does depends on what it remembers, so that it has no one well.
  [[nodiscard]] bool remembers() const { return !manifest->state.empty(); }
};

/// Instances, in lattice units. Who takes a copy of one shares it.
struct StageModels {
  core::CollisionOperator collision;
  std::vector<std::vector<core::MembraneLaw>> membranes;  ///< active laws of each cell type; nothing without cells
  std::vector<core::Potential> interactions;              ///< in the order of the scene; an inactive one has no table
};

struct Models {
  const scene::Scene* scene;
  PlannedModel collision;
  std::vector<std::vector<PlannedModel>> membranes;  ///< for each cell type
  std::vector<PlannedModel> interactions;            ///< in the order of Scene::interactions
  std::vector<scene::StageSetting> stages;
  std::vector<std::shared_ptr<const StageModels>> made;  ///< of each stage; stages with the same units share theirs
  bool has_cells = false;
  bool viscosity_contrast = false;
  bool has_interactions = false;       ///< between cells
  bool has_wall_interactions = false;  ///< between cells and walls
  bool has_self_interactions = false;  ///< between parts of one membrane

  /// Models whose libraries the run opens.
  [[nodiscard]] std::vector<const PlannedModel*> active_models() const;
  /// The cell type of a law, the two types of an interaction ("rbc, platelet"); empty for the fluid's model.
  [[nodiscard]] std::string owner_of(const PlannedModel& model) const;
};

/// Finds the models and resolves their parameters, and converts the stages; nothing is made yet. Adds what is wrong: a
/// model that is not known, a parameter, what the scene asks of a model and its manifest does not give.
Models choose_models(const scene::Scene& scene, const plugin::Catalog& catalog, Faults& faults);

/// Makes every active model. Throws Error(bad_input) with the place in the scene of what a model refuses,
/// Error(plugin_refused) for a library that is refused.
void make_models(Models& models);

/// A potential with other parameters than the scene's (SI, in its manifest's order), for stage 0.
core::Potential make_potential(const Models& models, const PlannedModel& model, const std::vector<double>& values);

/// Adds what is wrong with the models that a scene names, known or unknown, and their parameters. The scene may be one
/// that could not be read whole; `faults` has why.
void find_model_faults(const scene::Scene& scene, const plugin::Catalog& catalog, Faults& faults);

}  // namespace rouleau::plan
