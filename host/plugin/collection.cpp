#include "collection.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/text.hpp"
#include "json/document.hpp"
#include "json/schema.hpp"

namespace rouleau::plugin {

Collection read_collection(const std::filesystem::path& file) {
  const json::Document document = json::Document::read(file);
  json::validate(document, collection_schema());
  Collection collection{document.root()["title"], {}};
  std::set<std::pair<std::string, std::string>> seen;
  for (const auto& entry : document.root()["plugins"]) {
    const std::string at = "/plugins/" + std::to_string(collection.plugins.size());
    if (!seen.emplace(entry["id"].get<std::string>(), entry["version"].get<std::string>()).second) {
      throw Error(Cause::bad_input, document.place(at + "/version"),
                  "the index has this version of " + in_quotes(entry["id"].get<std::string>()) +
                      " twice; give one of them another version, or take it out");
    }
    collection.plugins.push_back({entry["id"], entry["kind"], entry["version"], entry["manifest_sha256"]});
  }
  return collection;
}

Found compare(const CollectedPlugin& plugin, const std::vector<Manifest>& manifests) {
  const auto found = std::find_if(manifests.begin(), manifests.end(),
                                  [&](const Manifest& manifest) { return manifest.id == plugin.id; });
  if (found == manifests.end()) return Found::nowhere;
  if (found->version != plugin.version) return Found::other_version;
  const bool same = found->sha256 == plugin.manifest_sha256 && to_string(found->kind) == plugin.kind;
  return same ? Found::same : Found::differs;
}

}  // namespace rouleau::plugin
