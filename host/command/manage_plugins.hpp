// Plugins of the user's own folder: rouleau plugins --install DIR; the lock of a scene: rouleau plugins --lock SCENE.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plugin/catalog.hpp"

namespace rouleau::command {

/// Copies all plugins of a folder, manifest and library of each, into the user's own, after they have passed the checks
/// of the interface; all of them or, where one is refused, none. `overwrite`: also over what an earlier installation
/// has put there. Throws Error(bad_input) for a folder without plugins, and for an id that is taken;
/// Error(plugin_refused) for a plugin that does not conform; Error(input_output).
void install_plugins(const std::filesystem::path& folder, const plugin::Catalog& catalog, bool overwrite);

/// Writes to `out` (empty: beside the scene), whole or not at all, and prints what is locked. Throws Error as for a
/// run: bad_input for a wrong scene, plugin_refused for a plugin that cannot be used, input_output.
void lock_scene(const std::filesystem::path& scene, const std::vector<std::filesystem::path>& plugin_dirs,
                const std::filesystem::path& out);

/// The command that makes a scene's lock anew, for when a plugin is meant to differ from it: a remedy's words.
std::string lock_renewal(const std::filesystem::path& lock, const std::filesystem::path& scene);

}  // namespace rouleau::command
