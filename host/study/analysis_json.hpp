// The study's conclusions as they stand in study.json.
#pragma once

#include <vector>

#include "analysis.hpp"
#include "json/json.hpp"
#include "target.hpp"

namespace rouleau::study {

/// Puts "quantities", "fronts", "knobs" and "sentences" into study.json, and "results" into each of its "points", which
/// must stand there in the order of the study's points. Their
/// ids are their indices. Numbers that are not defined are null.
void add_analysis(nlohmann::json& result, const StudyData& study, const std::vector<QuantityAnalysis>& analyses);

/// The value of "target".
nlohmann::json target_json(const StudyData& study, std::size_t quantity, double target, const TargetDecision& decision);

}  // namespace rouleau::study
