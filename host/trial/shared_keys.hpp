// Keys that the files of studies and of limits have in common: scene, set, time_limit.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "json/document.hpp"

namespace rouleau::trial {

/// The file of "scene", which begins with the document's folder; the document's own where the scene stands in it.
std::filesystem::path scene_file_of(const json::Document& document, const std::filesystem::path& file);

/// The scene with the changes of "set", which may have spoilt it. `whose`: "study's", for the message that the file is
/// not there. Throws Error(bad_input).
nlohmann::json read_changed_scene(const json::Document& document, const std::filesystem::path& scene_file,
                                  const std::string& whose);

/// "time_limit" in seconds; `example` stands in the message about one out of range. Throws Error(bad_input).
double read_time_limit(const json::Document& document, const std::string& example);

}  // namespace rouleau::trial
