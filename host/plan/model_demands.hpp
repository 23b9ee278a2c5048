// What a scene asks of its models, held against what their manifests say they take, give and remember.
#pragma once

#include <string>
#include <vector>

#include "plan.hpp"

namespace rouleau::plan {

/// A demand on a model, by where it stands in a scene.
struct Demand {
  /// takes, gives: the input or output must be in its manifest. lacks: it must not, for nothing stands for it there.
  enum class What { takes, gives, lacks } what;
  std::string quantity;  ///< as in a manifest's needs and gives; "state": what it remembers
  std::string why;       ///< a clause: "the cells are more viscous than the fluid around them"
};

/// On the collision operator, by viscosities, membranes and what drives the fluid.
std::vector<Demand> demands_on_operator(const Plan& plan);
/// On the potential of an interaction, by what it acts between.
std::vector<Demand> demands_on(const scene::Interaction& interaction);

/// Throws Error(bad_input) at the model's place with all demands that it does not meet, and the models of the catalog
/// that meet all. Nothing for a model that was not found.
void require(const std::vector<Demand>& demands, const PlannedModel& model, const scene::Scene& scene,
             const plugin::Catalog& catalog);

}  // namespace rouleau::plan
