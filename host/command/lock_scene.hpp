// Writes the lock of a scene: what its plugins are now.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rouleau::command {

/// Writes to `out` (empty: beside the scene), whole or not at all, and prints what is locked. Throws Error as for a
/// run: bad_input for a wrong scene, plugin_refused for a plugin that cannot be used, input_output.
void lock_scene(const std::filesystem::path& scene, const std::vector<std::filesystem::path>& plugin_dirs,
                const std::filesystem::path& out);

/// The command that makes a scene's lock anew, for when a plugin is meant to differ from it: a remedy's words.
std::string lock_renewal(const std::filesystem::path& lock, const std::filesystem::path& scene);

}  // namespace rouleau::command
