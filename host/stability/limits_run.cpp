#include "limits_run.hpp"

#include <cmath>
#include <iostream>

#include "base/error.hpp"
#include "base/text.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "json/put_value.hpp"
#include "limits_files.hpp"
#include "run/provenance.hpp"
#include "trial/fingerprint.hpp"
#include "trial/result_directory.hpp"

namespace rouleau::stability {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// What was kept of a trial beside its run; nothing where it must be run (again).
std::optional<trial::TrialResult> read_trial(const fs::path& file, const std::string& whole, const fs::path& directory,
                                             double time_limit_s) {
  if (!fs::exists(file)) return std::nullopt;
  const Json kept = Json::parse(files::read_text(file), nullptr, false);
  try {
    trial::TrialResult result;
    const auto end = trial::trial_end_named(kept.at("end"));
    if (!end || *end == trial::TrialEnd::interrupted || kept.at("fingerprint") != whole) return std::nullopt;
    // What did not end in time may with more of it.
    if (*end == trial::TrialEnd::timed_out && kept.at("time_limit_s").get<double>() < time_limit_s) return std::nullopt;
    if (*end == trial::TrialEnd::completed && !fs::exists(directory / "summary.json")) return std::nullopt;
    result.end = *end;
    result.message = kept.at("message");
    result.summary = kept.at("summary");
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;  // damaged: it is run again
  }
}

void write_trial(const fs::path& file, const std::string& whole, const trial::TrialResult& result,
                 double time_limit_s) {
  const Json kept = {{"fingerprint", whole},
                     {"end", trial::to_string(result.end)},
                     {"message", result.message},
                     {"time_limit_s", time_limit_s},
                     {"summary", result.summary}};
  files::write_file(file, kept.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

/// A message in one line, without its place in a scene that the user does not have.
std::string in_one_line(const Json& message) {
  if (!message.is_string()) return "";
  const std::string whole = message.get<std::string>();
  const std::size_t indented = whole.find("\n  ");
  const bool placed = indented != std::string::npos && whole.find(".scene.json") < indented;
  const std::string text = placed ? whole.substr(indented + 3) : whole;
  return text.substr(0, text.find('\n'));
}

std::string told(const Judgement& judgement) { return judgement.sound ? "stable" : failure_text(judgement.failure); }

}  // namespace

LimitsRun::LimitsRun(const LimitsFile& limits, LimitsOptions options)
    : limits_(limits), options_(std::move(options)), points_folder_(options_.directory / "points") {
  trial::take_result_directory(options_.directory, {"limits.json", "limits command", "program"}, directory_lock_);
  state_.limits = &limits_;
  state_.started = run::present_time();
}

bool LimitsRun::run() {
  write();
  if (limits_.parameter) {
    for (const trial::Point& point : trial::cross(limits_.axes)) {
      if (interrupted()) break;
      search(point);
      write();
    }
  }
  for (const ExtremeCase& extreme : limits_.cases) {
    if (interrupted()) break;
    try_case(extreme);
    write();
  }
  if (!interrupted()) state_.finished = run::present_time();
  write();
  return !interrupted();
}

void LimitsRun::search(const trial::Point& point) {
  const LimitsParameter& parameter = *limits_.parameter;
  const Json scene = trial::scene_of(limits_.scene, limits_.axes, point);
  CombinationResult result{point, {}, {}, {}};
  say(trial::name_of(limits_.axes, point) + ":");
  result.search = find_edges(parameter.range, [&](double value) -> std::optional<bool> {
    Json tried = scene;
    for (const std::string& pointer : parameter.pointers)
      (void)json::put_value(tried, pointer, parameter.written(value));
    std::optional<JudgedRun> run = try_scene(tried, limits_.steps);
    if (!run) return std::nullopt;
    const bool sound = run->judgement.sound;
    say("  " + parameter.name + ' ' + number(value) + (parameter.unit.empty() ? "" : ' ' + parameter.unit) + ": " +
        told(run->judgement));
    result.trials.push_back({value, std::move(run->judgement)});
    result.scene_file = run->directory.string() + ".scene.json";
    return sound;
  });
  state_.combinations.push_back(std::move(result));
}

void LimitsRun::try_case(const ExtremeCase& extreme) {
  std::optional<JudgedRun> run = try_scene(extreme.scene, extreme.steps);
  if (!run) return;
  CaseResult result = judge_case(extreme, std::move(run->judgement), run->directory);
  say(extreme.name + ": " + result.verdict + ": " + result.outcome +
      (result.as_expected ? "" : " (NOT AS EXPECTED: " + extreme.expect + ")"));
  state_.cases.push_back(std::move(result));
}

std::optional<JudgedRun> LimitsRun::try_scene(const Json& scene, long steps) {
  if (interrupted()) return std::nullopt;
  const std::string whole = trial::fingerprint(scene, limits_.scene_file, {"steps " + std::to_string(steps)});
  const fs::path directory = points_folder_ / trial::directory_name(whole);
  const fs::path file = directory.string() + ".json";
  std::optional<trial::TrialResult> result = read_trial(file, whole, directory, limits_.time_limit_s);
  if (!result) {
    trial::Trial trial{scene, limits_.scene_file, directory, 1, limits_.time_limit_s};
    trial.program = options_.program;
    trial.written_scene = directory.string() + ".scene.json";
    trial.interrupted = options_.interrupted;
    if (steps > 0) trial.options = {"--max-steps", std::to_string(steps)};
    result = trial::run_trial(trial);
    if (result->end == trial::TrialEnd::interrupted) return std::nullopt;
    write_trial(file, whole, *result, limits_.time_limit_s);
  }
  return JudgedRun{judge(*result, directory, limits_.soundness), directory};
}

void LimitsRun::write() const { write_limits_files(state_, options_.directory); }

void LimitsRun::say(const std::string& line) const {
  if (!options_.quiet) std::cerr << line << std::endl;
}

CaseResult judge_case(const ExtremeCase& extreme, Judgement judgement, const fs::path& directory) {
  CaseResult result;
  result.extreme = &extreme;
  const bool completed = judgement.end == "completed";
  if (judgement.sound && extreme.answer) {
    const RightAnswer& answer = *extreme.answer;
    const double found = last_value(directory, answer);
    if (!(std::abs(found - answer.value) <= answer.tolerance)) {
      judgement.sound = false;
      judgement.failure =
          failure_json("wrong_answer", answer.column + " is " + number(found) + " at the end, and should be " +
                                           number(answer.value) + " +- " + number(answer.tolerance));
    }
  }
  const bool has_reason =
      (judgement.end == "diverged" || judgement.end == "refused") && judgement.failure["reason"] != no_number_written;
  result.verdict = judgement.sound                                         ? "right answer"
                   : has_reason && judgement.failure["reason"].is_string() ? "stopped with a reason"
                                                                           : "WRONG";
  if (judgement.sound) {
    result.outcome = extreme.answer ? "came to its end and to the right answer" : "came to its end, and is sound";
  } else {
    result.outcome = (completed ? std::string() : told(judgement) + ": ") + in_one_line(judgement.failure["message"]);
  }
  result.as_expected = extreme.expect == "right"   ? result.verdict == "right answer"
                       : extreme.expect == "stops" ? result.verdict == "stopped with a reason"
                                                   : result.verdict != "WRONG";
  result.judgement = std::move(judgement);
  return result;
}

}  // namespace rouleau::stability
