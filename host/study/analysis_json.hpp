// The study's conclusions as they stand in study.json.
#pragma once

#include <vector>

#include "analysis.hpp"
#include "json/json.hpp"

namespace rouleau::study {

/// Puts "quantities", "fronts", "knobs" and "sentences" into study.json, and "results" into each of its "points", which
/// must stand there in the order of the study's points. Their
/// ids are their indices. Numbers that are not defined are null.
void add_analysis(nlohmann::json& result, const StudyData& study, const std::vector<QuantityAnalysis>& analyses);

}  // namespace rouleau::study
