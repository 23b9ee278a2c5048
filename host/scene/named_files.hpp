// What a scene names is part of it: files, and cells that are shipped.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "json/document.hpp"
#include "json/json.hpp"

namespace rouleau::scene {

/// JSON pointers of all objects of a scene that name a file, as text with the key "file", or a list of them: meshes,
/// tables of cells, pictures. Such an object may have its hash, "sha256", beside it, or a list of hashes.
std::vector<std::string> entries_with_files(const nlohmann::json& scene);

/// What the files of shipped cells fit: cell.schema.json.
const nlohmann::json& cell_schema();

/// Names of the cells that are shipped, in order: those of the files in share/rouleau/cells.
std::vector<std::string> cell_names();

struct ShippedCell {
  std::filesystem::path file;
  nlohmann::json content;  ///< fits cell.schema.json
};
/// The cell of this name, which was asked for at `place`. Throws Error(bad_input) where there is none.
ShippedCell shipped_cell(const std::string& name, const Place& place);

/// Cell types that name a shipped cell, "from", get those of its keys that are not written, and in place of the name
/// this and the hash of the cell's file: the document means the same whatever is installed later. Adds faults.
void take_shipped_cells(json::Document& scene, Faults& faults);

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
