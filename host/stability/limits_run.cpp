#include "limits_run.hpp"

#include <cmath>

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

/// A message in one line, without its place in a scene that the user does not have.
std::string in_one_line(const Json& message) {
  if (!message.is_string()) return "";
  const std::string whole = message.get<std::string>();
  const std::size_t indented = whole.find("\n  ");
  const bool placed = indented != std::string::npos && whole.find(".scene.json") < indented;
  const std::string text = placed ? whole.substr(indented + 3) : whole;
  return text.substr(0, text.find('\n'));
}

std::string words_of(const Judgement& judgement) {
  return judgement.healthy ? "stable" : failure_text(judgement.failure);
}

}  // namespace

LimitsRun::LimitsRun(const LimitsFile& limits, trial::CampaignOptions options)
    : limits_(limits), directory_(options.directory), campaign_(trial::limits_kind, limits, std::move(options)) {
  state_.limits = &limits_;
  state_.started = run::present_time();
}

bool LimitsRun::run() {
  write();
  if (limits_.parameter) {
    for (const trial::Point& point : trial::cross(limits_.axes)) {
      if (campaign_.interrupted()) break;
      search(point);
      write();
    }
  }
  for (const ExtremeCase& extreme : limits_.cases) {
    if (campaign_.interrupted()) break;
    try_case(extreme);
    write();
  }
  if (!campaign_.interrupted()) state_.finished = run::present_time();
  write();
  return !campaign_.interrupted();
}

void LimitsRun::search(const trial::Point& point) {
  const LimitsParameter& parameter = *limits_.parameter;
  const Json scene = trial::scene_of(limits_.scene, limits_.axes, point);
  CombinationResult result{point, {}, {}};
  campaign_.say(trial::name_of(limits_.axes, point) + ":");
  result.search = find_edges(parameter.range, [&](double value) -> std::optional<bool> {
    Json tried = scene;
    for (const std::string& pointer : parameter.pointers)
      (void)json::put_value(tried, pointer, parameter.written(value));
    std::optional<JudgedRun> run = try_scene(tried, limits_.steps);
    if (!run) return std::nullopt;
    const bool healthy = run->judgement.healthy;
    campaign_.say("  " + parameter.name + ' ' + number(value) + (parameter.unit.empty() ? "" : ' ' + parameter.unit) +
                  ": " + words_of(run->judgement));
    result.trials.push_back({value, std::move(run->judgement)});
    return healthy;
  });
  state_.combinations.push_back(std::move(result));
}

void LimitsRun::try_case(const ExtremeCase& extreme) {
  std::optional<JudgedRun> run = try_scene(extreme.scene, extreme.steps);
  if (!run) return;
  CaseResult result = judge_case(extreme, std::move(run->judgement), run->directory);
  campaign_.say(extreme.name + ": " + result.verdict + ": " + result.outcome +
                (result.as_expected ? "" : " (NOT AS EXPECTED: " + extreme.expect + ")"));
  state_.cases.push_back(std::move(result));
}

std::optional<JudgedRun> LimitsRun::try_scene(const Json& scene, long steps) {
  if (campaign_.interrupted()) return std::nullopt;
  const std::string whole = trial::fingerprint(scene, limits_.scene_file, {"steps " + std::to_string(steps)});
  std::optional<trial::PointRecord> record = campaign_.find(whole);
  if (!record) {
    trial::Trial trial = campaign_.trial_of(scene, whole);
    trial.max_steps = steps;
    const trial::TrialResult result = campaign_.run(trial);
    if (result.end == trial::TrialEnd::interrupted) return std::nullopt;
    campaign_.keep(record, whole, result);
  }
  const fs::path directory = campaign_.directory_of(whole);
  return JudgedRun{judge(trial::result_of(*record, directory), directory, limits_.criteria), directory};
}

void LimitsRun::write() const { write_limits_files(state_, directory_); }

CaseResult judge_case(const ExtremeCase& extreme, Judgement judgement, const fs::path& directory) {
  CaseResult result;
  result.extreme = &extreme;
  const bool completed = judgement.end == "completed";
  if (judgement.healthy && extreme.answer) {
    const RightAnswer& answer = *extreme.answer;
    const double found = last_value(directory, answer);
    if (!(std::abs(found - answer.value) <= answer.tolerance)) {
      judgement.healthy = false;
      judgement.failure =
          failure_json("wrong_answer", answer.column + " is " + number(found) + " at the end, and should be " +
                                           number(answer.value) + " +- " + number(answer.tolerance));
    }
  }
  const bool has_reason =
      (judgement.end == "diverged" || judgement.end == "refused") && judgement.failure["reason"] != no_number_written;
  result.verdict = judgement.healthy                                       ? "right answer"
                   : has_reason && judgement.failure["reason"].is_string() ? "stopped with a reason"
                                                                           : "WRONG";
  if (judgement.healthy) {
    result.outcome = extreme.answer ? "came to its end and to the right answer" : "came to its end, and is sound";
  } else {
    result.outcome =
        (completed ? std::string() : words_of(judgement) + ": ") + in_one_line(judgement.failure["message"]);
  }
  result.as_expected = extreme.expect == "right"   ? result.verdict == "right answer"
                       : extreme.expect == "stops" ? result.verdict == "stopped with a reason"
                                                   : result.verdict != "WRONG";
  result.judgement = std::move(judgement);
  return result;
}

}  // namespace rouleau::stability
