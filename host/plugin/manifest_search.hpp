// Finds the JSON files below a list of folders, in the same order on every machine.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace rouleau::plugin {

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
