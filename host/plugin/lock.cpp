#include "lock.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "base/input_file.hpp"
#include "base/text.hpp"
#include "json/document.hpp"
#include "json/schema.hpp"
#include "json/shown.hpp"
#include "library.hpp"

namespace rouleau::plugin {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

const LockedPlugin* Lock::find(const std::string& id) const {
  const auto found = std::find_if(plugins.begin(), plugins.end(), [&](const auto& plugin) { return plugin.id == id; });
  return found == plugins.end() ? nullptr : &*found;
}

fs::path lock_beside(const fs::path& scene) {
  return fs::path(scene).replace_filename(scene.stem().string() + ".lock.json");
}

LockedPlugin lock_plugin(const Manifest& manifest) {
  (void)checked_library(manifest);  // it must be there now
  return {manifest.id, to_string(manifest.kind), manifest.version, library_sha256(manifest), manifest.sha256};
}

std::string lock_text(std::vector<LockedPlugin> plugins) {
  std::sort(plugins.begin(), plugins.end(),
            [](const auto& a, const auto& b) { return std::tie(a.kind, a.id) < std::tie(b.kind, b.id); });
  ordered_json lock = {{"lock", 1}, {"plugins", ordered_json::array()}};
  for (const LockedPlugin& plugin : plugins) {
    lock["plugins"].push_back({{"id", plugin.id},
                               {"kind", plugin.kind},
                               {"version", plugin.version},
                               {"library_sha256", plugin.library_sha256},
                               {"manifest_sha256", plugin.manifest_sha256}});
  }
  return lock.dump(2) + '\n';
}

Lock read_lock(const fs::path& file, const std::string& renewal) {
  const json::Document document = json::Document::read(file);
  json::validate(document, lock_schema());
  Lock lock{file, renewal, sha256_of(document.text()), {}};
  std::set<std::string> seen;
  const auto& plugins = document.root()["plugins"];
  for (std::size_t i = 0; i < plugins.size(); ++i) {
    const auto& entry = plugins[i];
    if (!seen.insert(entry["id"]).second) {
      throw Error(Cause::bad_input, document.place("/plugins/" + std::to_string(i) + "/id"),
                  "the lock holds " + json::shown(entry["id"]) + " twice", {renewal});
    }
    lock.plugins.push_back(
        {entry["id"], entry["kind"], entry["version"], entry["library_sha256"], entry["manifest_sha256"]});
  }
  return lock;
}

void require_locked(const Lock& lock, const Manifest& manifest, const Place& place) {
  const auto refuse = [&](const std::string& problem) {
    throw Error(Cause::plugin_refused, place, problem, {lock.renewal});
  };
  const std::string name = "the plugin " + in_quotes(manifest.id), file = lock.file.string();
  const LockedPlugin* locked = lock.find(manifest.id);
  if (locked == nullptr) {
    std::vector<std::string> ids;
    for (const LockedPlugin& plugin : lock.plugins) ids.push_back(plugin.id);
    refuse(name + " is not in the lock " + file + ", which holds: " + listed(ids) +
           (place.line == 0 && !place.pointer.empty()  // it has no place in the text
                ? "\n  a lock binds a changed scene, too: write the model into the scene before you lock it"
                : ""));
    return;
  }
  const auto differs = [&](const char* what, const std::string& expected, const std::string& found) {
    if (expected == found) return;
    refuse(name + " of " + manifest.file.string() + " is not the one that is locked\n  expected " + what + ' ' +
           expected + ", by the lock " + file + "\n  found " + what + ' ' + found);
  };
  differs("kind", locked->kind, to_string(manifest.kind));
  differs("version", locked->version, manifest.version);
  differs("SHA-256 of the manifest", locked->manifest_sha256, manifest.sha256);
}

}  // namespace rouleau::plugin
