// What is known of the edges and cases of a limits file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limits_document.hpp"
#include "trial/campaign.hpp"

namespace rouleau::stability {

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
