// Writes the lock of a scene: what its plugins are now.
#pragma once

#include <filesystem>
#include <vector>

namespace rouleau::command {

/// Writes to `out` (empty: beside the scene), whole or not at all, and prints what is locked. Throws Error as for a
/// run: bad_input for a wrong scene, plugin_refused for a plugin that cannot be used, input_output.
void lock_scene(const std::filesystem::path& scene, const std::vector<std::filesystem::path>& plugin_dirs,
                const std::filesystem::path& out);

}  // namespace rouleau::command
