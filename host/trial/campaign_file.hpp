// What the files of studies and of limits have in common: a scene, changes of it, a matrix, a time limit.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "json/document.hpp"
#include "json/json.hpp"
#include "matrix.hpp"

namespace rouleau::trial {

/// The two commands that run campaigns, as their messages and files name them.
struct CampaignKind {
  const char* name;                ///< of its results: NAME.json, NAME.csv, and the keys NAME_file, rouleau_NAME_result
  const char* whose;               ///< "the path begins with the WHOSE folder"
  const char* command;             ///< "no COMMAND wrote"
  const char* program;             ///< "another PROGRAM is writing"
  double time_limit_s;             ///< of one run, where the file says nothing
  const char* time_limit_example;  ///< in the message about one out of range
};
inline constexpr CampaignKind study_kind{"study", "study's", "study", "study", 3600, "10 min"};
inline constexpr CampaignKind limits_kind{"limits", "limits file's", "limits command", "program", 120, "2 min"};

struct CampaignFile {
  std::shared_ptr<const json::Document> document;
  std::string title;
  std::filesystem::path file;
  std::filesystem::path scene_file;  ///< the file itself where it holds the scene
  nlohmann::json scene;              ///< with the changes of "set"
  std::vector<Axis> axes;
  double time_limit_s = 0;  ///< of one run
};

/// Throws Error(bad_input) with the place of the first fault, in the file or in its scene, Error(input_output) for a
/// file that cannot be read.
CampaignFile read_campaign_file(const CampaignKind& kind, const std::filesystem::path& file,
                                const nlohmann::json& schema);

/// Checks a changed scene as far as that is possible without plugins. Throws Error(bad_input) with a place in a text
/// called `name`, which the user does not have.
void check_scene(const nlohmann::json& scene, const std::string& name);

}  // namespace rouleau::trial
