#include "summary.hpp"

#include "json/number_or_null.hpp"

namespace rouleau::run {

namespace {

using Json = nlohmann::json;

Json to_json(const monitor::Failure& failure) {
  return {{"reason", failure.reason},
          {"step", failure.step},
          {"time_s", json::number_or_null(failure.time)},
          {"strain", json::number_or_null(failure.strain)},
          {"place_m", {json::number_or_null(failure.place[0]), json::number_or_null(failure.place[1])}},
          {"cell", failure.cell < 0 ? Json(nullptr) : Json(failure.cell)},
          {"value", json::number_or_null(failure.value)},
          {"limit", json::number_or_null(failure.limit)},
          {"message", failure.message},
          {"remedy", failure.remedy},
          {"mode", failure.mode.name},
          {"wavelength_segments", json::number_or_null(failure.mode.wavelength)},
          {"tangential_share", json::number_or_null(failure.mode.tangential_share)},
          {"mode_step", failure.mode.step < 0 ? Json(nullptr) : Json(failure.mode.step)}};
}

Json written(const observe::AggregateEvent& event) {
  return {{"strain", json::number_or_null(event.strain)},
          {"time_s", json::number_or_null(event.time)},
          {"count", event.count},
          {"members", event.members},
          {"through_image", event.through_image}};
}

/// Every name a script may rely on is there, as null where the run did not define it.
Json dimensionless(const Json& given) {
  Json all = given.is_object() ? given : Json::object();
  for (const char* name : {"reynolds_physical", "reynolds_simulated", "capillary", "membrane_strain", "adhesion_number",
                           "viscosity_ratio", "mach_max"})
    if (!all.contains(name)) all[name] = nullptr;
  for (auto& value : all)
    if (value.is_number_float()) value = json::number_or_null(value.get<double>());
  return all;
}

bool cut_short(const Json& stages) {
  return stages.is_array() && !stages.empty() && stages.back().value("ended_by", "") == "max_steps";
}

}  // namespace

std::string outcome(const Summary& summary) {
  const std::string steps = std::to_string(summary.steps);
  if (summary.status == "completed" && cut_short(summary.stages)) {
    return "cut short by the limit of steps at step " + steps + " of at most " + std::to_string(summary.steps_at_most);
  }
  return summary.status + " after " + steps + (summary.steps == 1 ? " step" : " steps");
}

Json to_json(const Summary& summary) {
  Json result;
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
  result["strain"] = json::number_or_null(summary.strain);
  result["simulated_time_s"] = json::number_or_null(summary.simulated_time_s);
  result["wall_s"] = json::number_or_null(summary.wall_s);
  result["steps_per_s"] = json::number_or_null(summary.steps_per_s);
  result["mlups"] = json::number_or_null(summary.mlups);
  result["peak_rss_bytes"] = summary.peak_rss_bytes;
  result["checkpoint_step"] = summary.checkpoint_step ? Json(*summary.checkpoint_step) : Json(nullptr);
  result["threads"] = summary.threads;
  result["precision"] = summary.precision;

  result["plugins"] = Json::array();
  for (const auto& plugin : summary.plugins)
    result["plugins"].push_back({{"id", plugin.id},
                                 {"version", plugin.version},
                                 {"kind", plugin.kind},
                                 {"library", plugin.library},
                                 {"sha256", plugin.sha256}});
  result["lock"] = summary.lock ? Json{{"file", summary.lock->file}, {"sha256", summary.lock->sha256}} : Json();
  result["passes"] = Json::array();
  for (const auto& pass : summary.passes)
    result["passes"].push_back(
        {{"name", pass.name}, {"wall_s", json::number_or_null(pass.wall_s)}, {"calls", pass.calls}});
  result["left_out"] = Json::array();
  for (const auto& omission : summary.left_out)
    result["left_out"].push_back({{"what", omission.what}, {"why", omission.why}});

  result["dimensionless"] = dimensionless(summary.dimensionless);
  result["limits"] = Json::array();
  for (const auto& limit : summary.limits)
    result["limits"].push_back({{"name", limit.name},
                                {"value", json::number_or_null(limit.value)},
                                {"limit", json::number_or_null(limit.limit)},
                                {"margin", json::number_or_null(limit.margin)},
                                {"remedy", limit.remedy}});
  result["wells"] = summary.wells.is_null() ? Json::array() : summary.wells;
  result["conservation"] = {{"mass_drift", json::number_or_null(summary.mass_drift)},
                            {"area_drift_max", json::number_or_null(summary.area_drift_max)},
                            {"area_leakage_max", json::number_or_null(summary.area_leakage_max)},
                            {"momentum_residual", json::number_or_null(summary.momentum_residual)}};
  const bool cells = summary.stretch[1] > 0;
  result["stretch"] =
      cells ? Json{{"min", json::number_or_null(summary.stretch[0])}, {"max", json::number_or_null(summary.stretch[1])}}
            : Json();
  result["aggregates_final"] = summary.aggregates_final;
  result["aggregate_history"] = Json::array();
  for (const auto& event : summary.aggregate_history) result["aggregate_history"].push_back(written(event));

  result["warnings"] = summary.warnings;
  result["numerics_choice"] = summary.numerics_choice;
  result["conversions"] = summary.conversions.is_null() ? Json::array() : summary.conversions;
  result["packings"] = summary.packings.is_null() ? Json::array() : summary.packings;
  result["energy"] = summary.energy;
  result["output_estimate"] = summary.output_estimate;
  result["rheology"] = summary.rheology.is_null() ? Json::array() : summary.rheology;
  result["stages"] = summary.stages.is_null() ? Json::array() : summary.stages;
  result["resumed"] = summary.resumed.is_null() ? Json::array() : summary.resumed;
  return result;
}

}  // namespace rouleau::run
