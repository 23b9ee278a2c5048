// Runs the points of a study, one after the other, and keeps study.json true to what is there.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "analysis_json.hpp"
#include "trial/campaign.hpp"
#include "trial/point_record.hpp"

namespace rouleau::study {

struct StudyOptions : trial::CampaignOptions {
  double budget_s = std::numeric_limits<double>::infinity();  ///< wall time of all runs of this call
};

class StudyRun {
 public:
  /// Makes the directory, or goes on in the one that a study has left. Throws Error(bad_input) for a directory with
  /// other files or that another study is writing into.
  StudyRun(const Study& study, StudyOptions options);

  /// Runs what has not been run, the cheapest points first. False when interrupted.
  bool run();

  [[nodiscard]] const StudyState& state() const { return state_; }

 private:
  enum class PointEnd { done, interrupted, out_of_budget };

  void prepare();
  void prepare_point(MatrixPoint& point);
  void plan_point(MatrixPoint& point);
  void run_all();
  [[nodiscard]] int runs_missing(const MatrixPoint& point) const;
  [[nodiscard]] double expected_s(const MatrixPoint& point) const;
  [[nodiscard]] std::vector<MatrixPoint*> missing_points();
  /// In its turn among the timed runs of this machine; then study.json tells of it.
  PointEnd take_turn(MatrixPoint& point);
  PointEnd run_point(MatrixPoint& point);
  trial::TrialResult run_once(const MatrixPoint& point, bool warm_up);
  void keep(MatrixPoint& point, const trial::TrialResult& result);
  void write() const;

  const Study& study_;
  StudyOptions options_;
  trial::Campaign campaign_;
  StudyState state_;
  trial::RunCost cost_;
  double spent_s_ = 0;
  files::FileLock timing_lock_;
};

}  // namespace rouleau::study
