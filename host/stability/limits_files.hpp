// limits.json, limits.csv, limits.html and the table on the terminal: what is known of the edges.
#pragma once

#include <filesystem>
#include <string>

#include "json/json.hpp"
#include "limits_document.hpp"

namespace rouleau::stability {

/// What limits.json says (limits-result.schema.json).
nlohmann::json limits_json(const LimitsState& state);
/// The edges as a table, one row each.
std::string limits_csv(const nlohmann::json& limits);
/// The same for a terminal.
std::string limits_text(const nlohmann::json& limits);

/// Writes limits.json, limits.csv and limits.html into the directory, each whole or not at all. Throws
/// Error(input_output).
void write_limits_files(const LimitsState& state, const std::filesystem::path& directory);

}  // namespace rouleau::stability
