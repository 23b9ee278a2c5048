// The files that a scene names are part of it.
#pragma once

#include <string>
#include <vector>

#include "json/json.hpp"

namespace rouleau::scene {

/// JSON pointers of all objects of a scene that name a file, as text with the key "file", or a list of them: meshes,
/// tables of cells, pictures. Such an object may have its hash, "sha256", beside it, or a list of hashes.
std::vector<std::string> entries_with_files(const nlohmann::json& scene);

/// Calls visit(text) for a text, or for each of a list of texts; true where it is one of both.
template <class Json, class Visit>
bool each_text(Json& texts, Visit visit) {
  if (!texts.is_array()) {
    if (texts.is_string()) visit(texts);
    return texts.is_string();
  }
  for (auto& text : texts) {
    if (!text.is_string()) return false;
    visit(text);
  }
  return !texts.empty();
}

}  // namespace rouleau::scene
