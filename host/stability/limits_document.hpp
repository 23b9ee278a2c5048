// A limits file as the user wrote it: scene, combinations of methods, the parameter whose edge is sought, cases; and
// what has been found of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bisection.hpp"
#include "json/json.hpp"
#include "judgement.hpp"
#include "trial/campaign.hpp"

namespace rouleau::stability {

struct LimitsParameter {
  std::string name, unit;  ///< unit: empty for plain numbers
  std::vector<std::string> pointers;
  SearchRange range;  ///< in the unit
  /// As it stands in a scene: "6e-06 N/m", or a number.
  [[nodiscard]] nlohmann::json written(double value) const;
};

/// What the last row of a table should say.
struct RightAnswer {
  std::string table, column, source;
  int cell = 0;
  double value = 0, tolerance = 0;
};

struct ExtremeCase {
  std::string name, expect;  ///< right, stops, either
  nlohmann::json scene;
  long steps = 0;  ///< 0: all of the scene's
  std::optional<RightAnswer> answer;
};

struct LimitsFile : trial::CampaignFile {
  std::optional<LimitsParameter> parameter;
  std::vector<ExtremeCase> cases;
  long steps = 0;  ///< of a trial; 0: all of the scene's
  HealthCriteria criteria;
};

/// Throws Error(bad_input) with the place of the first fault, in the file or in its scene; Error(input_output) for one
/// that cannot be read.
LimitsFile read_limits(const std::filesystem::path& file);

/// The schemas of a limits file and of its limits.json.
const nlohmann::json& limits_schema();
const nlohmann::json& limits_result_schema();

struct LimitsTrial {
  double value;
  Judgement judgement;
};

/// What was found for one combination of methods.
struct CombinationResult {
  trial::Point point;
  EdgeSearch search;
  std::vector<LimitsTrial> trials;  ///< in the order of the search
};

struct CaseResult {
  const ExtremeCase* extreme;
  Judgement judgement;
  std::string verdict;  ///< "right answer", "stopped with a reason", "WRONG"
  std::string outcome;  ///< one sentence
  bool as_expected = false;
};

struct LimitsState {
  const LimitsFile* limits;
  std::vector<CombinationResult> combinations;
  std::vector<CaseResult> cases;
  std::string started, finished;  ///< finished: empty while it runs
};

}  // namespace rouleau::stability
