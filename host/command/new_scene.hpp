// rouleau new scene NAME [TEMPLATE]: a scene with notes, to begin one's own from.
#pragma once

#include <filesystem>
#include <string>

namespace rouleau::command {

/// Writes folder/NAME.json, the template of that name (demo, channel, suspension or capsule), and prints what comes next.
/// Throws Error(bad_input) for a name that is no file's, a template that there is not, and a file that is there already;
/// Error(input_output).
void new_scene(const std::filesystem::path& folder, const std::string& name, const std::string& template_name);

}  // namespace rouleau::command
