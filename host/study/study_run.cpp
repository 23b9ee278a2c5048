#include "study_run.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis_json.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "run/provenance.hpp"
#include "trial/point_record.hpp"

namespace rouleau::study {

namespace {

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
  std::string text = record.steps.dump() + " steps in " + time_in_words(*least);
  if (walls.size() > 1) text += " to " + time_in_words(*most);
  return text;
}

}  // namespace

StudyRun::StudyRun(const Study& study, StudyOptions options)
    : study_(study),
      options_(std::move(options)),
      campaign_(trial::study_kind, study, options_),
      timing_lock_(files::timing_lock_file()) {
  state_.study = &study_;
  state_.started = run::present_time();
}

void StudyRun::prepare() {
  const std::vector<trial::Point> all = trial::cross(study_.axes);
  for (std::size_t i = 0; i < all.size(); ++i) {
    state_.points.push_back({static_cast<int>(i), all[i], trial::scene_of(study_.scene, study_.axes, all[i]),
                             trial::threads_of(study_.axes, all[i], study_.threads)});
    prepare_point(state_.points.back());
  }
  for (MatrixPoint& point : state_.points)
    if (runs_missing(point) > 0 && !campaign_.interrupted()) plan_point(point);
}

void StudyRun::prepare_point(MatrixPoint& point) {
  point.fingerprint = trial::fingerprint(point.scene, study_.scene_file,
                                         {"threads " + std::to_string(point.threads), run::machine_description()});
  point.record = campaign_.find(point.fingerprint);
  if (point.record)
    measure_point(study_, point, campaign_.directory_of(point.fingerprint));
  else
    point.left_out = "not yet run";
}

void StudyRun::plan_point(MatrixPoint& point) {
  const Json plan = trial::plan_trial(campaign_.trial_of(point.scene, point.fingerprint));
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
  for (MatrixPoint& point : state_.points)
    if (runs_missing(point) > 0) missing.push_back(&point);
  std::stable_sort(missing.begin(), missing.end(),
                   [&](const MatrixPoint* a, const MatrixPoint* b) { return expected_s(*a) < expected_s(*b); });
  return missing;
}

bool StudyRun::run() {
  prepare();
  const std::size_t missing = missing_points().size(), all = state_.points.size();
  if (missing < all)
    campaign_.say(std::to_string(all - missing) + " of " + std::to_string(all) + " points have been run before");
  write();
  run_all();
  if (!campaign_.interrupted()) state_.finished = run::present_time();
  write();
  return !campaign_.interrupted();
}

/// What is learnt from one point may change which is the cheapest of the others.
void StudyRun::run_all() {
  std::set<int> passed;  // by the budget
  while (!campaign_.interrupted()) {
    std::vector<MatrixPoint*> missing = missing_points();
    std::erase_if(missing, [&](const MatrixPoint* point) { return passed.count(point->id) != 0; });
    if (missing.empty()) return;
    MatrixPoint& point = *missing.front();
    const double expected = expected_s(point), left = std::max(0.0, options_.budget_s - spent_s_);
    if (expected > left) {
      passed.insert(point.id);
      if (!point.record)
        point.left_out =
            "expected to take " + time_in_words(expected) + "; " + time_in_words(left) + " of the budget were left";
      continue;
    }
    double all = 0;
    for (const MatrixPoint* other : missing) all += expected_s(*other);
    campaign_.say(trial::name_of(study_.axes, point.point) + ": expected " + time_in_words(expected) + "; " +
                  std::to_string(missing.size()) + " of " + std::to_string(state_.points.size()) + " points left, " +
                  time_in_words(std::min(all, left)));
    if (take_turn(point) != PointEnd::done) passed.insert(point.id);
  }
}

StudyRun::PointEnd StudyRun::take_turn(MatrixPoint& point) {
  if (!campaign_.wait_for(timing_lock_, "  waiting: another study on this machine is taking times"))
    return PointEnd::interrupted;
  // Another point may have had the same scene.
  if (!point.record) point.record = campaign_.find(point.fingerprint);
  const PointEnd end = run_point(point);
  timing_lock_.release();
  if (end == PointEnd::out_of_budget && !point.record) point.left_out = "stopped when the budget was used up";
  if (end != PointEnd::interrupted && point.record) {
    point.left_out.clear();
    measure_point(study_, point, campaign_.directory_of(point.fingerprint));
    campaign_.say("  " + words_of(point));
    if (!point.record->difference.empty()) campaign_.say("  NOT DETERMINISTIC: " + point.record->difference);
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

trial::TrialResult StudyRun::run_once(const MatrixPoint& point, bool warm_up) {
  trial::Trial trial = campaign_.trial_of(point.scene, point.fingerprint);
  trial.threads = point.threads;
  trial.time_limit_s = std::min(study_.time_limit_s, options_.budget_s - spent_s_);
  if (warm_up) trial.max_steps = std::max(1L, std::lround(warm_up_part * point.steps_at_most));
  trial::TrialResult result = campaign_.run(trial);
  const bool by_budget = result.end == trial::TrialEnd::timed_out && trial.time_limit_s < study_.time_limit_s;
  if (by_budget || warm_up) campaign_.discard(point.fingerprint);
  return result;
}

void StudyRun::keep(MatrixPoint& point, const trial::TrialResult& result) {
  campaign_.keep(point.record, point.fingerprint, result);
  if (result.end == trial::TrialEnd::completed && result.summary.is_object())
    cost_.learn(point.point, point.estimated_s, result.summary.value("wall_s", result.wall_s), result.wall_s);
}

void StudyRun::write() const { write_study_files(state_, options_.directory); }

}  // namespace rouleau::study
