// Finds, reads and checks manifests.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "json/document.hpp"
#include "manifest.hpp"

namespace rouleau::plugin {

/// The schema of a manifest.
const nlohmann::json& manifest_schema();
/// Text of a manifest as JSON with places. Throws Error(plugin_refused) when it cannot be read or is no JSON.
json::Document read_manifest_document(const std::filesystem::path& file);
/// Validates a manifest. Throws Error(plugin_refused) with place, problem and remedy.
Manifest read_manifest(const json::Document& document, const std::filesystem::path& file, const units::Units& units);
/// Reads and validates a manifest. Throws Error(plugin_refused) with place, problem and remedy.
Manifest read_manifest(const std::filesystem::path& file, const units::Units& units);

struct FoundFile {
  std::filesystem::path path;
  /// The first folder from the searched one down to the file's own that every user may write to; empty: none.
  std::filesystem::path open_folder;
};

struct FoundFiles {
  std::vector<FoundFile> files;  ///< folder by folder; within one by name, before its sub-folders
  std::vector<std::pair<std::filesystem::path, std::string>> unreadable;  ///< place and reason
};

/// All regular files *.json in the folders and their sub-folders. Links are followed; a file or folder that several
/// ways lead to is found once, by the first, so loops end. What cannot be read is reported and skipped.
/// Throws Error(bad_input) for a folder with more than 10'000 folders in it, which no folder of plugins is.
FoundFiles find_json_files(const std::vector<std::filesystem::path>& folders);

}  // namespace rouleau::plugin
