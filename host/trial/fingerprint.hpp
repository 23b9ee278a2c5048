// What a result depends on, as one hash: the same scene, program and plugins need not be run again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "json/json.hpp"

namespace rouleau::trial {

/// SHA-256 of this very program's file.
std::string program_sha256();

struct UsedPlugin {
  std::string id, library_sha256, manifest_sha256;
};
/// The plugins that a scene names, by the search path of its folder, ordered by id; none is opened. One that nobody
/// offers or that is refused has empty hashes: the run will say why.
std::vector<UsedPlugin> plugins_named(const nlohmann::json& scene, const std::filesystem::path& scene_file);

/// SHA-256 over the scene (keys in order, folders of plugins left out), the lock beside its file, the program, the
/// plugins and whatever else the result depends on, as the number of threads. Throws Error(input_output).
std::string fingerprint(const nlohmann::json& scene, const std::filesystem::path& scene_file,
                        const std::vector<std::string>& further = {});

/// Its first 16 digits, which name the directory of a run.
std::string directory_name(const std::string& fingerprint);

}  // namespace rouleau::trial
