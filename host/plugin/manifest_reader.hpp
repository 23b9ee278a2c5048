// Reads and checks a manifest.
#pragma once

#include <filesystem>

#include "json/document.hpp"
#include "manifest.hpp"

namespace rouleau::plugin {

/// The schema of a manifest.
const nlohmann::json& manifest_schema();
/// Text of a manifest as JSON with places. Throws Error(plugin_refused) when it cannot be read or is no JSON.
json::Document read_manifest_document(const std::filesystem::path& file);
/// Validates a manifest. Throws Error(plugin_refused) with place, problem and remedy.
Manifest read_manifest(const json::Document& document, const std::filesystem::path& file, const units::Units& units);
/// Reads and validates a manifest. Throws Error(plugin_refused) with place, problem and remedy.
Manifest read_manifest(const std::filesystem::path& file, const units::Units& units);

}  // namespace rouleau::plugin
