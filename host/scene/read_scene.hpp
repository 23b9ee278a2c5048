// Reads a scene: its text as JSON, checked by the schema, and what it says in SI.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "json/document.hpp"
#include "json/json.hpp"
#include "scene.hpp"

namespace rouleau::scene {

/// The schema of a scene.
const nlohmann::json& scene_schema();

/// A scene's text with `overrides` put in. They are "POINTER=VALUE" as given to --set; VALUE is any JSON value, or a
/// bare word taken as a string. Faults by the schema are added. Throws Error(bad_input) for text that is no JSON and
/// for overrides that cannot be put in, Error(input_output) when the file cannot be read.
json::Document read_document(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                             Faults& faults);
/// The same; throws what is wrong by the schema.
json::Document read_document(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// Converts a document, and nothing more: cells that are placed at random are in `packings` alone, and numerics that
/// the scene leaves open are those that Numerics begins with (plan::read_scene() reads a scene whole). Relative folders
/// begin with that of the document's file. `faults` has what the schema has found in the document; what is found here
/// is added, but for what follows from a fault. With faults, the scene is what could be read, for who looks for more of
/// them.
Scene read_scene(std::shared_ptr<const json::Document> document, Faults& faults);
/// Converts a document that fits the schema. Throws what is found, Error(bad_input).
Scene read_scene(std::shared_ptr<const json::Document> document);

}  // namespace rouleau::scene
