// The state of a study and its conclusions, as they stand in study.json, study.csv and study.html.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis.hpp"
#include "json/json.hpp"
#include "study_document.hpp"
#include "trial/point_record.hpp"

namespace rouleau::study {

/// A point of the matrix and what is known of it.
struct MatrixPoint {
  int id;  ///< place in cross()
  trial::Point point;
  nlohmann::json scene;
  int threads;
  std::string fingerprint = {};
  double estimated_s = 0;                         ///< by the plan, one run; NaN: the plan refused
  double steps_at_most = 0;                       ///< by the plan
  std::optional<trial::PointRecord> record = {};  ///< whole or with fewer repeats than asked for
  std::vector<Measured> results = {};             ///< for each quantity, once it has been run
  std::string left_out = {};                      ///< why it has not been run; empty: it has
};

struct StudyState {
  const Study* study;
  std::vector<MatrixPoint> points;  ///< by id
  std::string started, finished;    ///< finished: empty while it runs
  [[nodiscard]] bool complete() const;
};

/// Takes the study's quantities from a point's run. Throws Error(input_output).
void measure_point(const Study& study, MatrixPoint& point, const std::filesystem::path& directory);

/// The study as its conclusions are drawn from: every point, run or not, in the order of their ids.
StudyData study_data(const StudyState& state);

/// Puts "quantities", "fronts", "knobs" and "sentences" into study.json, and "results" into each of its "points", which
/// must stand there in the order of the study's points. Their
/// ids are their indices. Numbers that are not defined are null.
void add_analysis(nlohmann::json& result, const StudyData& study, const std::vector<QuantityAnalysis>& analyses);

/// What study.json says (study-result.schema.json).
nlohmann::json study_json(const StudyState& state);
/// The same as a table, one row per point.
std::string study_csv(const nlohmann::json& study);

/// Writes these and the page into the directory. Throws Error(input_output).
void write_study_files(const StudyState& state, const std::filesystem::path& directory);

}  // namespace rouleau::study
