// study.json, study.csv and study.html: how a study stands, each whole or not at all.
#pragma once

#include <filesystem>
#include <string>

#include "json/json.hpp"
#include "study_state.hpp"

namespace rouleau::study {

/// What study.json says (study-result.schema.json).
nlohmann::json study_json(const StudyState& state);
/// The same as a table, one row per point.
std::string study_csv(const nlohmann::json& study);

/// Writes these and the page into the directory. Throws Error(input_output).
void write_study_files(const StudyState& state, const std::filesystem::path& directory);

}  // namespace rouleau::study
