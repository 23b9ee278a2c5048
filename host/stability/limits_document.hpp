// A limits file as the user wrote it: scene, combinations of methods, and the parameter whose edge is
// sought; and what has been found of it.
#pragma once

#include <filesystem>
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

struct LimitsFile : trial::CampaignFile {
  LimitsParameter parameter;
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

struct LimitsState {
  const LimitsFile* limits;
  std::vector<CombinationResult> combinations;
  std::string started, finished;  ///< finished: empty while it runs
};

}  // namespace rouleau::stability
