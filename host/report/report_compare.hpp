// What a comparison of runs shows: the data of each, and what differs in scenes, plugins and outcome.
#pragma once

#include <filesystem>
#include <vector>

#include "json/json.hpp"

namespace rouleau::report {

/// {runs: [report_data of each, with "directory"], differences: {scene, plugins, outcome}} of runs that have ended.
///   scene     [{pointer, values}] by JSON pointer; null where a run's scene is missing
///   plugins   [{kind, id, values}] of those that not all runs used with the same version and library:
///             {version, sha256} of each
///   outcome   [{name, values, differs}] of the numbers and words that summary.json ends with
/// `values` has an entry for each run, null where it has nothing of the kind. Throws Error(bad_input) for a directory
/// that is no run's, or whose run has not ended.
nlohmann::json compare_data(const std::vector<std::filesystem::path>& directories);

/// Leaves (and whole values that not all sides have) in which JSON values differ, by JSON pointer.
nlohmann::json value_differences(const std::vector<nlohmann::json>& values);

nlohmann::json plugin_differences(const std::vector<nlohmann::json>& summaries);
nlohmann::json outcome_numbers(const std::vector<nlohmann::json>& summaries);

}  // namespace rouleau::report
