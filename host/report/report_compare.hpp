// What a comparison of two runs shows: the data of both, and what differs in scenes, plugins and outcome.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace rouleau::report {

/// {runs: [report_data of each, with "directory"], differences: {scene, plugins, outcome}} of two runs that have ended.
///   scene     [{pointer, a, b}] by JSON pointer; null where a run's scene is missing
///   plugins   [{kind, id, a, b}] of those that one run did not use or used with another version or library (SHA-256)
///   outcome   [{name, a, b, differs}] of the numbers and words that summary.json ends with
/// In all, a or b is absent where that run has nothing of the kind. Throws Error(bad_input) for a directory that is no
/// run's, or whose run has not ended.
nlohmann::json compare_data(const std::filesystem::path& a, const std::filesystem::path& b);

/// Leaves (and whole values that only one side has) in which two JSON values differ, by JSON pointer.
nlohmann::json value_differences(const nlohmann::json& a, const nlohmann::json& b);

nlohmann::json plugin_differences(const nlohmann::json& summary_a, const nlohmann::json& summary_b);
nlohmann::json outcome_numbers(const nlohmann::json& summary_a, const nlohmann::json& summary_b);

}  // namespace rouleau::report
