#include "limits_run.hpp"

#include "base/error.hpp"
#include "base/text.hpp"
#include "json/document.hpp"
#include "limits_files.hpp"
#include "run/provenance.hpp"
#include "trial/point_record.hpp"

namespace rouleau::stability {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

}  // namespace

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
