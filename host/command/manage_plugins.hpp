// Plugins of the user's own folder: rouleau plugins --install DIR; and what a published collection has of those that
// are there: rouleau plugins --index FILE.
#pragma once

#include <filesystem>
#include <vector>

#include "plugin/catalog.hpp"

namespace rouleau::command {

/// Copies all plugins of a folder, manifest and library of each, into the user's own, after they have passed the checks
/// of the interface; all of them or, where one is refused, none. `overwrite`: also over what an earlier installation
/// has put there. Throws Error(bad_input) for a folder without plugins, and for an id that is taken;
/// Error(plugin_refused) for a plugin that does not conform; Error(input_output).
void install_plugins(const std::filesystem::path& folder, const plugin::Catalog& catalog, bool overwrite);

/// Prints of each entry of an index whether it is installed, and as what. Throws Error(plugin_refused) where a plugin
/// has the version of the index and is not what the index says.
void compare_with_index(const std::filesystem::path& index, const plugin::Catalog& catalog);

}  // namespace rouleau::command
