#include "named_files.hpp"

#include "json/json_pointer.hpp"

namespace rouleau::scene {

namespace {

void collect(const nlohmann::json& value, const std::string& pointer, std::vector<std::string>& entries) {
  if (value.is_object() && value.contains("file") && each_text(value["file"], [](const auto&) {}))
    entries.push_back(pointer);
  for (const auto& [key, part] : value.items()) {
    if (part.is_structured()) collect(part, json::child_pointer(pointer, key), entries);
  }
}

}  // namespace

std::vector<std::string> entries_with_files(const nlohmann::json& scene) {
  std::vector<std::string> entries;
  if (!scene.is_object()) return entries;
  for (const auto& [key, part] : scene.items()) {
    if (part.is_structured() && key != "notes" && key != "expected")
      collect(part, json::child_pointer("", key), entries);
  }
  return entries;
}

}  // namespace rouleau::scene
