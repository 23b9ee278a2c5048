// rouleau new scene [TEMPLATE] [--name NAME]: a scene to begin one's own from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace rouleau::command {

/// What a new scene is called, and the template it is made from.
struct SceneWords {
  std::string name, from;
};

/// What is meant by up to two words and a --name, which may be empty: a word that is a template's is the template.
/// Throws Error(bad_input) where both words are.
SceneWords scene_words(const std::optional<std::string>& first, const std::string& second, const std::string& name);

/// Writes folder/NAME.json, the template of that name, and prints what it holds and what comes next.
/// Throws Error(bad_input) for a name that is no file's, a template that there is not, and a file that is there
/// already; Error(input_output).
void new_scene(const std::filesystem::path& folder, const std::string& name, const std::string& template_name);

}  // namespace rouleau::command
