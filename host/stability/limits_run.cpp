#include "limits_run.hpp"

#include <sstream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "files/tables.hpp"
#include "json/document.hpp"
#include "report/report.hpp"
#include "run/provenance.hpp"
#include "trial/campaign.hpp"
#include "trial/point_record.hpp"

namespace rouleau::stability {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace fs = std::filesystem;
using Json = nlohmann::json;

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json parameter_json(const LimitsParameter& parameter) {
  return {{"name", parameter.name},
          {"unit", parameter.unit},
          {"pointers", parameter.pointers},
          {"from", parameter.range.from},
          {"to", parameter.range.to},
          {"scale", parameter.range.scale == Scale::linear ? "linear" : "log"},
          {"precision", parameter.range.precision},
          {"whole", parameter.range.whole}};
}

Json trial_json(const LimitsTrial& trial) {
  const Json& f = trial.judgement.failure;
  const auto of = [&f](const char* key) { return f.is_object() ? f[key] : Json(); };
  return {{"value", trial.value}, {"end", trial.judgement.end}, {"reason", of("reason")}, {"step", of("step")}};
}

Json edge_json(const LimitsState& state, const CombinationResult& combination, std::size_t index) {
  const StabilityEdge& edge = combination.search.edges[index];
  Json failure, trials = Json::array();
  for (const LimitsTrial& trial : combination.trials) {
    if (edge.unstable_from && trial.value == *edge.unstable_from) failure = trial.judgement.failure;
    // Two edges share the trials of their search; they are listed with the first.
    if (index == 0) trials.push_back(trial_json(trial));
  }
  return {{"labels", trial::labels_of(state.limits->axes, combination.point)},
          {"direction", edge.direction == StabilityEdge::Direction::above ? "above" : "below"},
          {"stable_up_to", optional_json(edge.stable_up_to)},
          {"unstable_from", optional_json(edge.unstable_from)},
          {"out_of_order", combination.search.out_of_order},
          {"failure", failure},
          {"trials", trials}};
}

/// What a reader should know before trusting an edge.
Json limits_warnings(const LimitsState& state) {
  Json warnings = Json::array();
  for (const CombinationResult& combination : state.combinations) {
    if (combination.search.out_of_order.empty()) continue;
    std::string values;
    for (const double value : combination.search.out_of_order) {
      values += (values.empty() ? "" : ", ") + number(value);
      for (const LimitsTrial& trial : combination.trials)
        if (trial.value == value) values += trial.judgement.healthy ? " (stable)" : " (unstable)";
    }
    warnings.push_back(trial::name_of(state.limits->axes, combination.point) +
                       ": there is more than one edge; these values contradict the one that was found: " + values);
  }
  return warnings;
}

/// Six digits, as values are tried with.
Json rounded(const Json& value) { return value.is_number_float() ? Json(number(value.get<double>())) : value; }

std::string labels_text(const Json& labels) {
  std::string text;
  for (const auto& [name, label] : labels.items())
    text += (text.empty() ? "" : ", ") + name + ' ' + label.get<std::string>();
  return text.empty() ? "the scene" : text;
}

}  // namespace

Json limits_json(const LimitsState& state) {
  const LimitsFile& limits = *state.limits;
  Json edges = Json::array();
  bool complete = state.combinations.size() == trial::cross(limits.axes).size();
  for (const CombinationResult& combination : state.combinations) {
    complete = complete && combination.search.complete;
    for (std::size_t i = 0; i < combination.search.edges.size(); ++i) edges.push_back(edge_json(state, combination, i));
  }
  Json result = trial::result_head(trial::limits_kind, limits, state.started, state.finished, complete);
  result.update({{"sound", limits.criteria},
                 {"steps", limits.steps > 0 ? Json(limits.steps) : Json()},
                 {"parameter", parameter_json(limits.parameter)},
                 {"edges", edges},
                 {"warnings", limits_warnings(state)}});
  return result;
}

std::string limits_csv(const Json& limits) {
  Json head = {"parameter"};
  for (const Json& axis : limits["axes"]) head.push_back(axis["name"]);
  for (const char* name : {"direction", "stable_up_to", "unstable_from", "unit", "reason", "step"})
    head.push_back(name);
  std::string table = trial::csv_line(head);
  for (const Json& edge : limits["edges"]) {
    Json row = {limits["parameter"]["name"]};
    for (const Json& axis : limits["axes"]) row.push_back(edge["labels"][axis["name"].get<std::string>()]);
    for (const char* key : {"direction", "stable_up_to", "unstable_from"}) row.push_back(rounded(edge[key]));
    row.push_back(limits["parameter"]["unit"]);
    const Json& failure = edge["failure"];
    for (const char* key : {"reason", "step"}) row.push_back(failure.is_object() ? rounded(failure[key]) : Json());
    table += trial::csv_line(row);
  }
  return table;
}

std::string limits_text(const Json& limits) {
  std::ostringstream text;
  const auto value = [&](const Json& v) {
    const std::string unit = limits["parameter"]["unit"].get<std::string>();
    return number(v.get<double>()) + (unit.empty() ? "" : ' ' + unit);
  };
  text << limits["parameter"]["name"].get<std::string>() << "\n";
  for (const Json& edge : limits["edges"]) {
    text << "  " << labels_text(edge["labels"]) << ": ";
    const Json &stable = edge["stable_up_to"], &unstable = edge["unstable_from"];
    if (stable.is_null()) {
      text << "stable nowhere; ";
    } else if (unstable.is_null()) {
      text << "stable throughout";
    } else {
      text << (edge["direction"] == "above" ? "stable up to " : "stable down to ") << value(stable) << ", fails at "
           << value(unstable) << ": ";
    }
    text << (edge["failure"].is_null() ? "" : failure_text(edge["failure"])) << "\n";
  }
  for (const Json& warning : limits["warnings"]) text << "warning: " << warning.get<std::string>() << "\n";
  return text.str();
}

void write_limits_files(const LimitsState& state, const fs::path& directory) {
  const Json limits = limits_json(state);
  trial::write_result(trial::limits_kind, directory, limits, limits_csv(limits));
  report::write_limits_page(directory);
}

LimitsRun::LimitsRun(const LimitsFile& limits, trial::CampaignOptions options)
    : limits_(limits), directory_(options.directory), campaign_(trial::limits_kind, limits, std::move(options)) {
  state_.limits = &limits_;
  state_.started = run::present_time();
}

bool LimitsRun::run() {
  write();
  for (const trial::Point& point : trial::cross(limits_.axes)) {
    if (campaign_.interrupted()) break;
    search(point);
    write();
  }
  if (!campaign_.interrupted()) state_.finished = run::present_time();
  write();
  return !campaign_.interrupted();
}

void LimitsRun::search(const trial::Point& point) {
  const LimitsParameter& parameter = limits_.parameter;
  const Json scene = trial::scene_of(limits_.scene, limits_.axes, point);
  CombinationResult result{point, {}, {}};
  campaign_.say(trial::name_of(limits_.axes, point) + ":");
  result.search = find_edges(parameter.range, [&](double value) -> std::optional<bool> {
    Json tried = scene;
    for (const std::string& pointer : parameter.pointers)
      (void)json::put_value(tried, pointer, parameter.written(value));
    std::optional<Judgement> judgement = try_scene(tried);
    if (!judgement) return std::nullopt;
    const bool healthy = judgement->healthy;
    campaign_.say("  " + parameter.name + ' ' + number(value) + (parameter.unit.empty() ? "" : ' ' + parameter.unit) +
                  ": " + (healthy ? "stable" : failure_text(judgement->failure)));
    result.trials.push_back({value, *std::move(judgement)});
    return healthy;
  });
  state_.combinations.push_back(std::move(result));
}

std::optional<Judgement> LimitsRun::try_scene(const Json& scene) {
  if (campaign_.interrupted()) return std::nullopt;
  const std::string whole = trial::fingerprint(scene, limits_.scene_file, {"steps " + std::to_string(limits_.steps)});
  std::optional<trial::PointRecord> record = campaign_.find(whole);
  if (!record) {
    trial::Trial trial = campaign_.trial_of(scene, whole);
    trial.max_steps = limits_.steps;
    const trial::TrialResult result = campaign_.run(trial);
    if (result.end == trial::TrialEnd::interrupted) return std::nullopt;
    campaign_.keep(record, whole, result);
  }
  const fs::path directory = campaign_.directory_of(whole);
  return judge(trial::result_of(*record, directory), directory, limits_.criteria);
}

void LimitsRun::write() const { write_limits_files(state_, directory_); }

}  // namespace rouleau::stability
