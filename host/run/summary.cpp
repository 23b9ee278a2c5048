#include "summary.hpp"

namespace rouleau::run {

namespace {

using Json = nlohmann::json;

Json to_json(const monitor::Failure& failure) {
  return {{"reason", failure.reason},
          {"step", failure.step},
          {"time_s", failure.time},
          {"strain", failure.strain},
          {"place_m", std::vector(failure.place.begin(), failure.place.end())},
          {"cell", failure.cell < 0 ? Json(nullptr) : Json(failure.cell)},
          {"value", failure.value},
          {"limit", failure.limit},
          {"message", failure.message},
          {"remedy", failure.remedy}};
}

Json to_json(const observe::AggregateEvent& event) {
  Json json{{"strain", event.strain},
            {"time_s", event.time},
            {"count", event.count},
            {"members", event.members.empty() ? Json() : Json(event.members)},
            {"through_image", event.through_image}};
  if (!event.joined.empty()) json["joined"] = event.joined;
  if (!event.met_images.empty()) json["met_images"] = event.met_images;
  return json;
}

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

}  // namespace

void to_json(Json& json, const Continuation& continuation) {
  json = {{"step", continuation.step},
          {"threads", continuation.threads},
          {"ranks", continuation.ranks},
          {"accepted", continuation.accepted}};
  if (!continuation.damaged_checkpoint.empty()) json["damaged_checkpoint"] = continuation.damaged_checkpoint;
}

void from_json(const Json& json, Continuation& continuation) {
  json.at("step").get_to(continuation.step);
  json.at("threads").get_to(continuation.threads);
  continuation.ranks = json.value("ranks", 1);
  json.at("accepted").get_to(continuation.accepted);
  continuation.damaged_checkpoint = json.value("damaged_checkpoint", "");
}

std::string outcome(const Summary& summary) {
  const std::string steps = std::to_string(summary.steps);
  if (summary.status == "completed" && !summary.stages.empty() && summary.stages.back().ended_by == Ending::max_steps) {
    return "cut short by the limit of steps at step " + steps + " of at most " + std::to_string(summary.steps_at_most);
  }
  return summary.status + " after " + steps + (summary.steps == 1 ? " step" : " steps");
}

Json to_json(const Summary& summary) {
  Json result = plan::shared_sections(summary.plan);
  result["status"] = summary.status;
  if (summary.failure) result["failure"] = to_json(*summary.failure);
  result["title"] = summary.title;
  result["scene_file"] = summary.scene_file;
  result["scene_sha256"] = summary.scene_sha256;
  result["git"] = summary.git;
  result["machine"] = summary.machine;
  result["started"] = summary.started;

  result["outcome"] = outcome(summary);
  result["steps"] = summary.steps;
  result["steps_at_most"] = summary.steps_at_most;
  result["strain"] = summary.strain;
  result["simulated_time_s"] = summary.simulated_time_s;
  result["wall_s"] = summary.wall_s;
  result["steps_per_s"] = summary.steps_per_s;
  result["mlups"] = summary.mlups;
  result["peak_rss_bytes"] = summary.peak_rss_bytes;
  result["checkpoint_step"] = value_or_null(summary.checkpoint_step);
  result["threads"] = summary.threads;
  result["ranks"] = summary.ranks;
  result["message_library"] = summary.message_library.empty() ? Json() : Json(summary.message_library);
  result["dimensions"] = summary.dimensions;
  result["precision"] = summary.precision;
  result["instruction_set"] = summary.instruction_set;

  result["plugins"] = summary.plugins;
  result["lock"] = value_or_null(summary.lock);
  result["numerics_choice"] = plan::to_json(summary.numerics_choice);
  result["output_estimate"] = summary.plan.estimate.output;
  result["passes"] = summary.passes;

  Json& dimensionless = result["dimensionless"];
  dimensionless["mach_max"] = summary.mach_max;
  // Every name a script may rely on is there, as null where the run did not define it.
  for (const char* name : {"reynolds_physical", "reynolds_simulated", "capillary", "membrane_strain", "adhesion_number",
                           "viscosity_ratio"})
    dimensionless.emplace(name, nullptr);
  result["conservation"] = {{"mass_drift", summary.mass_drift},
                            {"area_drift_max", summary.area_drift_max},
                            {"area_leakage_max", summary.area_leakage_max},
                            {"momentum_residual", summary.momentum_residual}};
  const auto& [least, most] = summary.stretch;
  result["stretch"] = most > 0 ? Json{{"min", least}, {"max", most}} : Json();
  result["aggregates_final"] = summary.aggregates_final;
  Json& history = result["aggregate_history"] = Json::array();
  for (const observe::AggregateEvent& event : summary.aggregate_history) history.push_back(to_json(event));
  result["energy"] = summary.energy;
  result["rheology"] = summary.rheology;
  if (!summary.cell_traffic.is_null()) result["cell_traffic"] = summary.cell_traffic;
  if (!summary.plan.attracting.empty()) result["lifetimes"] = summary.lifetimes;
  result["stages"] = summary.stages;
  result["resumed"] = summary.resumed;
  return result;
}

}  // namespace rouleau::run
