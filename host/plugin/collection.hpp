// The index of a collection of plugins that somebody publishes: what each is, and the hashes by which it is known.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "manifest.hpp"

namespace rouleau::plugin {

struct CollectedPlugin {
  std::string id, kind, version;
  std::string manifest_sha256;
};

struct Collection {
  std::string title;
  std::vector<CollectedPlugin> plugins;
};

/// The schema of an index.
const nlohmann::json& collection_schema();
/// Throws Error(input_output) for an index that cannot be read, Error(bad_input) with the place for one that is damaged
/// or has a version of a plugin twice.
Collection read_collection(const std::filesystem::path& file);

/// What an entry of the index is beside the manifest that was found under its id.
enum class Found {
  nowhere,        ///< nobody offers the id
  same,           ///< the manifest of the index
  other_version,  ///< another version
  differs         ///< the version of the index, with another manifest or of another kind
};
Found compare(const CollectedPlugin& plugin, const std::vector<Manifest>& manifests);

}  // namespace rouleau::plugin
