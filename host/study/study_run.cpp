#include "study_run.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include "analysis_json.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "run/provenance.hpp"
#include "study_files.hpp"
#include "target.hpp"
#include "trial/fingerprint.hpp"
#include "trial/result_directory.hpp"

namespace rouleau::study {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A warm-up fills the caches of the system and lets the processor find its frequency; it need not go to the end.
constexpr double warm_up_part = 0.1;

std::string words_of(const MatrixPoint& point) {
  const trial::PointRecord& record = *point.record;
  if (record.end != trial::TrialEnd::completed) {
    std::string text = trial::to_string(record.end);
    const std::string message =
        record.failure["message"].is_string() ? record.failure["message"].get<std::string>() : "";
    if (record.failure["step"].is_number()) text += " at step " + record.failure["step"].dump();
    return message.empty() ? text : text + ": " + message.substr(0, message.find('\n'));
  }
  std::vector<double> walls;
  for (const trial::TimedRun& run : record.runs) walls.push_back(run.wall_s);
  const auto [least, most] = std::minmax_element(walls.begin(), walls.end());
  std::string text = record.steps.dump() + " steps in " + duration_text(*least);
  if (walls.size() > 1) text += " to " + duration_text(*most);
  return text;
}

}  // namespace

std::string duration_text(double seconds) {
  if (std::isnan(seconds)) return "an unknown time";
  if (seconds < 120) return number(seconds, 2) + " s";
  if (seconds < 7200) return number(seconds / 60, 2) + " min";
  return number(seconds / 3600, 2) + " h";
}

StudyRun::StudyRun(const Study& study, StudyOptions options)
    : study_(study),
      options_(std::move(options)),
      points_folder_(options_.directory / "points"),
      timing_lock_(trial::timing_lock_file()) {
  trial::take_result_directory(options_.directory, {"study.json", "study", "study"}, directory_lock_);
  state_.study = &study_;
  state_.started = run::present_time();
}

bool StudyRun::interrupted() const { return options_.interrupted != nullptr && *options_.interrupted; }

fs::path StudyRun::directory_of(const MatrixPoint& point) const {
  return points_folder_ / trial::directory_name(point.fingerprint);
}

void StudyRun::prepare() {
  const std::vector<trial::Point> all = trial::cross(study_.axes);
  for (std::size_t i = 0; i < all.size(); ++i) {
    state_.points.push_back({static_cast<int>(i), all[i], trial::scene_of(study_.scene, study_.axes, all[i]),
                             trial::threads_of(study_.axes, all[i], study_.threads)});
    prepare_point(state_.points.back());
  }
  for (MatrixPoint& point : state_.points) {
    if (runs_missing(point) > 0 && !interrupted()) plan_point(point);
  }
}

void StudyRun::prepare_point(MatrixPoint& point) {
  point.fingerprint = trial::fingerprint(point.scene, study_.scene_file,
                                         {"threads " + std::to_string(point.threads), run::machine_description()});
  point.record = trial::read_record(points_folder_, point.fingerprint);
  // What did not end in time may with more of it.
  if (point.record && point.record->end == trial::TrialEnd::timed_out &&
      point.record->time_limit_s < study_.time_limit_s)
    point.record.reset();
  if (point.record) {
    measure_point(study_, point, directory_of(point));
  } else {
    point.left_out = "not yet run";
  }
}

void StudyRun::plan_point(MatrixPoint& point) {
  trial::Trial trial{point.scene, study_.scene_file, directory_of(point)};
  trial.program = options_.program;
  trial.interrupted = options_.interrupted;
  const Json plan = trial::plan_trial(trial);
  point.estimated_s = plan.is_object() ? plan["estimate"].value("wall_s", NAN) : NAN;
  point.steps_at_most = plan.is_object() ? plan["estimate"].value("steps_at_most", 0.0) : 0;
}

/// Timed runs that a point still wants.
int StudyRun::runs_missing(const MatrixPoint& point) const {
  if (!point.record) return study_.repeats;
  if (point.record->end != trial::TrialEnd::completed) return 0;
  return std::max(0, study_.repeats - static_cast<int>(point.record->runs.size()));
}

/// Of all runs that a point still wants.
double StudyRun::expected_s(const MatrixPoint& point) const {
  // What the plan refuses the run refuses as quickly.
  const double one = cost_.expected_s(point.point, std::isnan(point.estimated_s) ? 0 : point.estimated_s);
  return one * (runs_missing(point) + (study_.warm_up ? warm_up_part : 0));
}

/// Cheapest first.
std::vector<MatrixPoint*> StudyRun::missing_points() {
  std::vector<MatrixPoint*> missing;
  for (MatrixPoint& point : state_.points) {
    if (runs_missing(point) > 0) missing.push_back(&point);
  }
  std::stable_sort(missing.begin(), missing.end(),
                   [&](const MatrixPoint* a, const MatrixPoint* b) { return expected_s(*a) < expected_s(*b); });
  return missing;
}

bool StudyRun::run() {
  prepare();
  const std::size_t missing = missing_points().size(), all = state_.points.size();
  if (missing < all) say(std::to_string(all - missing) + " of " + std::to_string(all) + " points have been run before");
  write();
  options_.target ? run_for_target() : run_all();
  if (!interrupted()) state_.finished = run::present_time();
  write();
  return !interrupted();
}

/// What is learnt from one point may change which is the cheapest of the others.
void StudyRun::run_all() {
  std::set<int> passed;  // by the budget
  while (!interrupted()) {
    std::vector<MatrixPoint*> missing = missing_points();
    std::erase_if(missing, [&](const MatrixPoint* point) { return passed.count(point->id) != 0; });
    if (missing.empty()) return;
    MatrixPoint& point = *missing.front();
    const double expected = expected_s(point), left = std::max(0.0, options_.budget_s - spent_s_);
    if (expected > left) {
      passed.insert(point.id);
      if (!point.record)
        point.left_out =
            "expected to take " + duration_text(expected) + "; " + duration_text(left) + " of the budget were left";
      continue;
    }
    double all = 0;
    for (const MatrixPoint* other : missing) all += expected_s(*other);
    say(trial::name_of(study_.axes, point.point) + ": expected " + duration_text(expected) + "; " +
        std::to_string(missing.size()) + " of " + std::to_string(state_.points.size()) + " points left, " +
        duration_text(std::min(all, left)));
    if (take_turn(point) != PointEnd::done) passed.insert(point.id);
  }
}

void StudyRun::run_for_target() {
  const StudyTarget& target = *options_.target;
  bool in_budget = true;
  while (!interrupted()) {
    // One run of a point stands for all of its repeats.
    const double left = in_budget ? (options_.budget_s - spent_s_) / (study_.repeats + 1) : 0;
    const StudyData data = study_data(state_);
    const TargetDecision decision = decide_target(data, target.quantity, target.error, left);
    if (!decision.next) {
      state_.target = target_json(data, target.quantity, target.error, decision);
      break;
    }
    MatrixPoint& point = state_.points[*decision.next];
    say(trial::name_of(study_.axes, point.point) + ": expected " + duration_text(expected_s(point)));
    in_budget = take_turn(point) == PointEnd::done;
  }
  if (interrupted()) return;
  for (MatrixPoint& point : state_.points) {
    if (!point.record) point.left_out = "not needed to find what meets the target, or beyond the budget";
  }
}

StudyRun::PointEnd StudyRun::take_turn(MatrixPoint& point) {
  const auto waits = [&] { say("  waiting: another study on this machine is taking times"); };
  if (!timing_lock_.wait(waits, options_.interrupted)) return PointEnd::interrupted;
  // Another point may have had the same scene.
  if (!point.record) point.record = trial::read_record(points_folder_, point.fingerprint);
  const PointEnd end = run_point(point);
  timing_lock_.release();
  if (end == PointEnd::out_of_budget && !point.record) point.left_out = "stopped when the budget was used up";
  if (end != PointEnd::interrupted && point.record) {
    point.left_out.clear();
    measure_point(study_, point, directory_of(point));
    say("  " + words_of(point));
    if (!point.record->difference.empty()) say("  NOT DETERMINISTIC: " + point.record->difference);
    write();
  }
  return end;
}

/// Every run that a point still wants, as far as the budget goes.
StudyRun::PointEnd StudyRun::run_point(MatrixPoint& point) {
  bool warm = !study_.warm_up;
  while (runs_missing(point) > 0) {
    const double left = options_.budget_s - spent_s_;
    if (left <= 0) return PointEnd::out_of_budget;
    const trial::TrialResult result = run_once(point, !warm);
    spent_s_ += result.wall_s;
    if (result.end == trial::TrialEnd::interrupted) return PointEnd::interrupted;
    if (result.end == trial::TrialEnd::timed_out && left < study_.time_limit_s) return PointEnd::out_of_budget;
    if (warm) keep(point, result);
    warm = true;
  }
  return PointEnd::done;
}

/// In a directory of its own, which takes its name when the run is whole.
trial::TrialResult StudyRun::run_once(const MatrixPoint& point, bool warm_up) {
  const fs::path directory = directory_of(point).string() + ".running";
  fs::remove_all(directory);
  trial::Trial trial{point.scene, study_.scene_file, directory, point.threads,
                     std::min(study_.time_limit_s, options_.budget_s - spent_s_)};
  trial.program = options_.program;
  trial.interrupted = options_.interrupted;
  trial.written_scene = directory_of(point).string() + ".scene.json";
  if (warm_up) {
    const long steps = std::max(1L, std::lround(warm_up_part * point.steps_at_most));
    trial.options = {"--max-steps", std::to_string(steps)};
  }
  trial::TrialResult result = trial::run_trial(trial);
  const bool by_study = result.end == trial::TrialEnd::timed_out && trial.time_limit_s < study_.time_limit_s;
  if (result.end == trial::TrialEnd::interrupted || by_study || warm_up) fs::remove_all(directory);
  return result;
}

void StudyRun::keep(MatrixPoint& point, const trial::TrialResult& result) {
  const fs::path whole = directory_of(point), ran = whole.string() + ".running";
  trial::PointRecord record = point.record.value_or(trial::PointRecord{});
  record.fingerprint = point.fingerprint;
  record.machine = run::machine_description();
  record.time_limit_s = study_.time_limit_s;
  trial::add_run(record, result, ran);
  const bool first = record.runs.size() == 1 || result.end != trial::TrialEnd::completed;
  if (first) fs::remove_all(whole);
  if (first && fs::exists(ran)) fs::rename(ran, whole);
  fs::remove_all(ran);
  trial::write_record(points_folder_, record);
  if (result.end == trial::TrialEnd::completed && result.summary.is_object())
    cost_.learn(point.point, point.estimated_s, result.summary.value("wall_s", result.wall_s), result.wall_s);
  point.record = std::move(record);
}

void StudyRun::write() const { write_study_files(state_, options_.directory); }

void StudyRun::say(const std::string& line) const {
  if (!options_.quiet) std::cerr << line << std::endl;
}

}  // namespace rouleau::study
