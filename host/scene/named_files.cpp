#include "named_files.hpp"

#include <algorithm>

#include "base/input_file.hpp"
#include "base/installation.hpp"
#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "json/json_pointer.hpp"
#include "json/schema.hpp"

namespace rouleau::scene {

namespace {

void collect(const nlohmann::json& value, const std::string& pointer, std::vector<std::string>& entries) {
  if (value.is_object() && value.contains("file") && each_text(value["file"], [](const auto&) {}))
    entries.push_back(pointer);
  for (const auto& [key, part] : value.items())
    if (part.is_structured()) collect(part, json::child_pointer(pointer, key), entries);
}

std::filesystem::path folder_of_cells() { return installation().data / "rouleau" / "cells"; }

/// `type` as written at `pointer`, which names a shipped cell.
void complete(json::Document& scene, const std::string& pointer, const nlohmann::json& type) {
  const std::string from = pointer + "/from", name = type["from"];
  const Place place = scene.place(from);
  const auto [file, content] = shipped_cell(name, place);
  const auto size = nlohmann::json::json_pointer("/domain/size");
  const std::size_t sides = scene.root().contains(size) ? scene.root()[size].size() : 0;
  if (sides == 2 && content["dimensions"] == 3)
    throw Error(Cause::bad_input, place, in_quotes(name) + " is a cell of three dimensions, and the domain has two",
                {"give size and nodes three numbers, or write shape and membrane in place of \"from\""});
  bool gives = false;
  for (const auto& [key, value] : content["cell_type"].items()) {
    if (type.contains(key)) continue;
    gives = true;
    scene.put(json::child_pointer(pointer, key), value, file.string());
  }
  if (!gives)
    throw Error(Cause::bad_input, place, in_quotes(name) + " gives nothing here, for each of its keys is written",
                {"leave out \"from\", or the keys that it is to give"});
  scene.put(from, {{"cell", name}, {"sha256", sha256(file)}}, file.string());
}

}  // namespace

std::vector<std::string> cell_names() {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder_of_cells(), ignored))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

ShippedCell shipped_cell(const std::string& name, const Place& place) {
  const std::vector<std::string> names = cell_names();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(Cause::bad_input, place,
                "no shipped cell is called " + in_quotes(name) + did_you_mean(name, names) +
                    "\n  there are: " + (names.empty() ? "none, in " + folder_of_cells().string() : listed(names)));
  const std::filesystem::path file = folder_of_cells() / (name + ".json");
  const json::Document document = json::Document::read(file);
  json::validate(document, cell_schema());
  return {file, document.root()};
}

void take_shipped_cells(json::Document& scene, Faults& faults) {
  if (!scene.root().is_object() || !scene.root().contains("cell_types")) return;
  const nlohmann::json types = scene.root()["cell_types"];
  if (!types.is_object()) return;
  for (const auto& [name, type] : types.items()) {
    if (!type.is_object() || !type.contains("from") || !type["from"].is_string()) continue;
    faults.attempt(
        [&, &name = name, &type = type] { complete(scene, json::child_pointer("/cell_types", name), type); });
  }
}

std::vector<std::string> entries_with_files(const nlohmann::json& scene) {
  std::vector<std::string> entries;
  if (!scene.is_object()) return entries;
  for (const auto& [key, part] : scene.items())
    if (part.is_structured() && key != "notes" && key != "expected")
      collect(part, json::child_pointer("", key), entries);
  return entries;
}

}  // namespace rouleau::scene
