// Who else could change a plugin: folders and files that every user of the machine may write to are not trusted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rouleau::plugin {

/// The first of the paths, links followed, that users other than its owner and group may write to; empty: none. With
/// the sticky bit, too, which keeps others from replacing a file but not from adding one. What cannot be looked at is
/// passed over: whoever opens it says why.
std::filesystem::path open_to_others(const std::vector<std::filesystem::path>& paths);

/// Why nothing is taken from that folder or file, with its mode and the remedy; continues a message's second line.
std::string why_not_trusted(const std::filesystem::path& open);

/// The folder that holds a file when all links are followed.
std::filesystem::path true_folder(const std::filesystem::path& file);

}  // namespace rouleau::plugin
