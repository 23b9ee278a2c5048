#include "output/summary.hpp"

#include <cmath>

namespace rouleau::host {

namespace {

using nlohmann::json;

/// JSON has no infinity and no NaN: undefined is null.
json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json to_json(const Failure& failure) {
  return {{"reason", failure.reason},
          {"step", failure.step},
          {"time_s", number(failure.time)},
          {"strain", number(failure.strain)},
          {"place_m", {number(failure.place[0]), number(failure.place[1])}},
          {"cell", failure.cell < 0 ? json(nullptr) : json(failure.cell)},
          {"value", number(failure.value)},
          {"limit", number(failure.limit)},
          {"message", failure.message},
          {"remedy", failure.remedy}};
}

json to_json(const AggregateEvent& event) {
  return {{"strain", number(event.strain)},
          {"time_s", number(event.time)},
          {"count", event.count},
          {"members", event.members},
          {"through_image", event.through_image}};
}

/// Every name a script may rely on is there, as null where the run did not define it.
json dimensionless(const json& given) {
  json all = given.is_object() ? given : json::object();
  for (const char* name : {"reynolds_physical", "reynolds_simulated", "capillary", "membrane_strain", "adhesion_number",
                           "viscosity_ratio", "mach_max"})
    if (!all.contains(name)) all[name] = nullptr;
  for (auto& value : all)
    if (value.is_number_float()) value = number(value.get<double>());
  return all;
}

bool cut_short(const json& stages) {
  return stages.is_array() && !stages.empty() && stages.back().value("ended_by", "") == "max_steps";
}

}  // namespace

std::string outcome(const Summary& summary) {
  const std::string steps = std::to_string(summary.steps);
  if (summary.status == "completed" && cut_short(summary.stages)) {
    return "cut short by --max-steps at step " + steps + " of at most " + std::to_string(summary.steps_at_most);
  }
  return summary.status + " after " + steps + (summary.steps == 1 ? " step" : " steps");
}

json to_json(const Summary& summary) {
  json result;
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
  result["strain"] = number(summary.strain);
  result["simulated_time_s"] = number(summary.simulated_time_s);
  result["wall_s"] = number(summary.wall_s);
  result["steps_per_s"] = number(summary.steps_per_s);
  result["mlups"] = number(summary.mlups);
  result["peak_rss_bytes"] = summary.peak_rss_bytes;
  result["threads"] = summary.threads;
  result["precision"] = summary.precision;

  result["plugins"] = json::array();
  for (const auto& plugin : summary.plugins)
    result["plugins"].push_back({{"id", plugin.id},
                                 {"version", plugin.version},
                                 {"kind", plugin.kind},
                                 {"library", plugin.library},
                                 {"sha256", plugin.sha256}});
  result["lock"] = summary.lock ? json{{"file", summary.lock->file}, {"sha256", summary.lock->sha256}} : json();
  result["passes"] = json::array();
  for (const auto& pass : summary.passes)
    result["passes"].push_back({{"name", pass.name}, {"wall_s", number(pass.wall_s)}, {"calls", pass.calls}});
  result["left_out"] = json::array();
  for (const auto& omission : summary.left_out)
    result["left_out"].push_back({{"what", omission.what}, {"why", omission.why}});

  result["dimensionless"] = dimensionless(summary.dimensionless);
  result["limits"] = json::array();
  for (const auto& limit : summary.limits)
    result["limits"].push_back({{"name", limit.name},
                                {"value", number(limit.value)},
                                {"limit", number(limit.limit)},
                                {"margin", number(limit.margin)},
                                {"remedy", limit.remedy}});
  result["wells"] = summary.wells.is_null() ? json::array() : summary.wells;
  result["conservation"] = {{"mass_drift", number(summary.mass_drift)},
                            {"area_drift_max", number(summary.area_drift_max)},
                            {"area_leakage_max", number(summary.area_leakage_max)},
                            {"momentum_residual", number(summary.momentum_residual)}};
  const bool cells = summary.stretch[1] > 0;
  result["stretch"] = cells ? json{{"min", number(summary.stretch[0])}, {"max", number(summary.stretch[1])}} : json();
  result["aggregates_final"] = summary.aggregates_final;
  result["aggregate_history"] = json::array();
  for (const auto& event : summary.aggregate_history) result["aggregate_history"].push_back(to_json(event));

  result["warnings"] = summary.warnings;
  result["conversions"] = summary.conversions.is_null() ? json::array() : summary.conversions;
  result["packings"] = summary.packings.is_null() ? json::array() : summary.packings;
  result["rheology"] = summary.rheology.is_null() ? json::array() : summary.rheology;
  result["stages"] = summary.stages.is_null() ? json::array() : summary.stages;
  return result;
}

}  // namespace rouleau::host
