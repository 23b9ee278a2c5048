// What a stage waits for must be able to come.
#include <string>

#include "base/text.hpp"
#include "dimension_words.hpp"
#include "driving_flow.hpp"
#include "scene_reader.hpp"

namespace rouleau::scene {

namespace {

/// What is missing for a column of series.csv to have values in a stage; empty: nothing.
std::string missing_for(const std::string& column, const Stage& stage, const Scene& scene) {
  const auto begins = [&](const char* text) { return column.starts_with(text); };
  const Domain& domain = scene.domain;
  const bool walls = domain.walled(1) || domain.has_shapes(), shears = walls_move(stage),
             kept = stage.pressure_gradient != Vector() || stage.mean_velocity || stage.changes(),
             driven = kept || scene.fluid.body_force != Vector(),
             cells = !scene.cells.empty() || !scene.packings.empty() || domain.feed() != nullptr;
  if (begins("inlet_") || begins("outlet_")) {
    if (!domain.is_open()) return "an inlet and an outlet";
    const int other = 5 - domain.dimension();  // flows are in m2/s or m3/s
    if (column.ends_with("_m" + std::to_string(other) + "_per_s"))
      return std::string(words_of(other).number) + " dimensions";
    return "";
  }
  if (!walls) return begins("pressure_gradient") && kept ? "" : "walls";
  if ((begins("cell_") || begins("aggregate_") || begins("discharge_")) && !cells) return "cells";
  if (begins("pressure_gradient")) return kept ? "" : "a pressure_gradient or mean_velocity";
  if (begins("flow_rate") || begins("mean_velocity") || begins("discharge_"))
    return driven && !shears ? "" : "a flow that a pressure_gradient or mean_velocity drives, between walls at rest";
  return begins("relative_viscosity") && !driven && !shears ? "a flow" : "";
}

void check_mean(const SceneFields& fields, const Stage& stage, const Scene& scene) {
  const std::string missing = missing_for(stage.until_mean, stage, scene);
  if (missing.empty()) return;
  fields.refuse_key(stage.pointer + "/until/" + stage.until_mean,
                    "this column of series.csv has no values without " + missing +
                        "\ntake another one, or end the stage by duration");
}

}  // namespace

void check_until(const SceneFields& fields, const Stage& stage, const Scene& scene, bool flows) {
  if (!stage.until_mean.empty()) check_mean(fields, stage, scene);
  if (!stage.until_at_rest && !stage.until_equilibrium) return;
  const std::string key = stage.pointer + "/until", word = fields.at(key).get<std::string>();
  if (flows) {
    fields.refuse(
        key, stage.until_at_rest
                 ? "cells never come to rest in a stage that flows; end it by duration or strain"
                 : "the flow puts energy in, so that there is no equilibrium; end the stage by duration or strain");
  }
  if (scene.cells.empty() && scene.packings.empty() && fields.settled("/cells")) {
    fields.refuse(key, "there are no cells that could come to " +
                           std::string(stage.until_at_rest ? "rest" : "an equilibrium") +
                           "; end the stage by duration");
  }
  if (!stage.duration) {
    fields.refuse(key, in_quotes(word) +
                           " needs a duration beside it, the longest time to wait: cells that never "
                           "come to rest would run for ever");
  }
}

}  // namespace rouleau::scene
