// What a scene will compute: models, facts of them, and decisions, before the first step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "facts.hpp"
#include "models.hpp"
#include "numerics_choice.hpp"
#include "plugin/lock.hpp"
#include "scene/lattice.hpp"

namespace rouleau::plan {

/// All that a run needs: its models, what is known of them, what was decided. What it will cost, what is left out and
/// what to be wary of is in a PlanReport.
struct Plan : Models {
  Facts facts = {};
  std::optional<NumericsChoice> numerics_choice = {};  ///< none where the scene pins all of its numerics
  bool semi_implicit = false;  ///< membranes: the step that numerics.coupling names or, if "auto", the limits ask for
  std::string coupling = {};   ///< which step that is and why, for people
  std::optional<plugin::LockUse> lock = {};  ///< the lock that the plugins were held against
};

/// A sentence for each library that lies in a folder of the scene's own plugin_dirs: code that comes with the scene.
std::vector<std::string> code_of_the_scene(const Plan& plan);

/// Whether the semi-implicit step bears more than the explicit one with the scene's kernel, at its relaxation time.
bool semi_implicit_gains(const scene::Scene& scene);

/// Makes every active model for every stage, so that a plan never promises a run that cannot start. Throws
/// Error(bad_input) with the place in the scene of what cannot be computed or a model refuses, Error(plugin_refused)
/// for a library that is refused. The scene and the catalog must outlive the plan; `choice` is what
/// read_within_limits() has put into the scene.
Plan make_plan(const scene::Scene& scene, const plugin::Catalog& catalog, std::optional<NumericsChoice> choice = {});

}  // namespace rouleau::plan
