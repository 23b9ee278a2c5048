// The files that a scene names are part of it.
#pragma once

#include <string>
#include <vector>

#include "json/json.hpp"

namespace rouleau::scene {

/// JSON pointers of all objects of a scene that name a file, as text with the key "file": meshes, tables of cells. Such
/// an object may have its hash, "sha256", beside it.
std::vector<std::string> entries_with_files(const nlohmann::json& scene);

}  // namespace rouleau::scene
