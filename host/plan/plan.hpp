// What a scene will compute and why, decided before the first step: models, passes, what is left out, limits, costs.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "limit.hpp"
#include "output_estimate.hpp"
#include "plugin/catalog.hpp"
#include "plugin/lock.hpp"
#include "plugin/parameters.hpp"
#include "stage_scales.hpp"

namespace rouleau::plan {

/// A model the scene names, with its parameters. An inactive one is left out: its library is not opened.
struct PlannedModel {
  const plugin::Manifest* manifest;
  plugin::ParameterValues parameters;
  std::string pointer;  ///< its place in the scene
  [[nodiscard]] bool active() const { return !parameters.inactive; }
};

struct PlannedPass {
  std::string name, why;
};

struct Estimate {
  double steps = 0;  ///< at most
  double wall_s = 0;
  double memory_bytes = 0;
  OutputEstimate output;
};

struct Plan {
  const scene::Scene* scene;
  PlannedModel collision;
  std::vector<std::vector<PlannedModel>> membranes;  ///< for each cell type
  std::vector<PlannedModel> interactions;            ///< in the order of Scene::interactions
  std::vector<StageSetting> stages;
  bool has_cells = false;
  bool viscosity_contrast = false;
  bool has_interactions = false;
  bool semi_implicit = false;  ///< membranes: the step that numerics.coupling names or, if "auto", the limits ask for
  std::string coupling;        ///< which step that is and why, for people

  std::optional<plugin::LockUse> lock;  ///< the lock that the plugins were held against

  std::vector<PlannedPass> passes;
  std::vector<Omission> left_out;
  std::vector<Limit> limits;
  std::vector<std::string> warnings;
  nlohmann::json dimensionless;
  nlohmann::json conversions;
  nlohmann::json wells;            ///< of the active interactions, in SI
  nlohmann::json packings;         ///< packing_table()
  nlohmann::json numerics_choice;  ///< object: what "numerics": "auto" chose and why; null where the scene pins all
  Estimate estimate;

  /// Models whose libraries the run opens.
  [[nodiscard]] std::vector<const PlannedModel*> active_models() const;
  /// The cell type of a law, the two types of an interaction ("rbc, platelet"); empty for the fluid's model.
  [[nodiscard]] std::string owner_of(const PlannedModel& model) const;
};

/// Throws Error(bad_input or plugin_refused). The scene and the catalog must outlive the plan.
Plan make_plan(const scene::Scene& scene, const plugin::Catalog& catalog);

/// Limits of the method for this scene (stability, accuracy), sharpest first. Opens the libraries of active models,
/// whose own derivatives give the stiffness that explicit coupling must bear.
std::vector<Limit> find_limits(const Plan& plan);

std::string to_text(const Plan& plan);
nlohmann::json to_json(const Plan& plan);

}  // namespace rouleau::plan
