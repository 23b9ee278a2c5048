// Runs the trials of a limits file, remembers what each came to, and keeps limits.json true to what is known.
#pragma once

#include <filesystem>
#include <optional>
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

class LimitsRun {
 public:
  /// Makes the directory, or goes on in the one that the same command has left. Throws Error(bad_input) for a directory
  /// with other files or that another program is writing into.
  LimitsRun(const LimitsFile& limits, trial::CampaignOptions options);

  /// Tries what has not been tried. False when interrupted.
  bool run();
  [[nodiscard]] const LimitsState& state() const { return state_; }

 private:
  void search(const trial::Point& point);
  /// Nothing when interrupted.
  std::optional<Judgement> try_scene(const nlohmann::json& scene);
  void write() const;

  const LimitsFile& limits_;
  std::filesystem::path directory_;
  trial::Campaign campaign_;
  LimitsState state_;
};

}  // namespace rouleau::stability
