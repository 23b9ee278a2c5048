// The points of a study and what is known of them while it runs; what study.json is made of.
#pragma once

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

}  // namespace rouleau::study
