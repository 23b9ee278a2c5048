#include "fingerprint.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/sha256.hpp"
#include "plugin/catalog.hpp"
#include "plugin/library.hpp"
#include "plugin/lock.hpp"
#include "scene/named_files.hpp"

namespace rouleau::trial {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

void collect_models(const Json& value, std::set<std::string>& models) {
  if (!value.is_structured()) return;
  if (value.is_object() && value.contains("model") && value["model"].is_string()) models.insert(value["model"]);
  for (const auto& part : value) collect_models(part, models);
}

std::vector<fs::path> scene_plugin_dirs(const Json& scene, const fs::path& scene_file) {
  std::vector<fs::path> folders;
  const fs::path beside = fs::absolute(scene_file).parent_path();
  const Json listed = scene.is_object() ? scene.value("plugin_dirs", Json::array()) : Json::array();
  for (const auto& folder : listed) {
    std::error_code ignored;
    const fs::path whole = folder.is_string() ? beside / folder.get<std::string>() : fs::path();
    if (fs::is_directory(whole, ignored)) folders.push_back(whole);
  }
  return folders;
}

}  // namespace

std::string program_sha256() {
  static const std::string hash = sha256("/proc/self/exe");
  return hash;
}

std::vector<UsedPlugin> plugins_named(const Json& scene, const fs::path& scene_file) {
  std::set<std::string> models{"trt"};  // what a fluid has that names no collision model
  collect_models(scene, models);
  const plugin::Catalog catalog(plugin::plugin_search_path({}, scene_plugin_dirs(scene, scene_file)));
  std::vector<UsedPlugin> used;
  for (const std::string& id : models) {
    const auto& offered = catalog.manifests();
    const auto found =
        std::find_if(offered.begin(), offered.end(), [&](const plugin::Manifest& m) { return m.id == id; });
    UsedPlugin plugin{id, {}, {}};
    try {
      if (found != offered.end()) plugin = {id, plugin::library_sha256(*found), found->sha256};
    } catch (const Error& error) {
      if (error.cause() != Cause::plugin_refused) throw;
    }
    used.push_back(plugin);
  }
  return used;
}

std::string fingerprint(const Json& scene, const fs::path& scene_file, const std::vector<std::string>& further) {
  Json all = {{"scene", scene}, {"program", program_sha256()}, {"plugins", Json::array()}, {"further", further}};
  if (all["scene"].is_object()) all["scene"].erase("plugin_dirs");
  if (all["scene"].is_object()) all["scene"].erase("notes");
  for (const UsedPlugin& plugin : plugins_named(scene, scene_file)) {
    all["plugins"].push_back({plugin.id, plugin.library_sha256, plugin.manifest_sha256});
  }
  for (const std::string& entry : scene::entries_with_files(scene)) {
    scene::each_text(scene.at(Json::json_pointer(entry + "/file")), [&](const Json& name) {
      const fs::path file = fs::absolute(scene_file).parent_path() / name.get<std::string>();
      std::error_code ignored;
      if (fs::is_regular_file(file, ignored) && fs::file_size(file, ignored) <= largest_named)
        all["files"].push_back(sha256(file));
    });
  }
  const fs::path lock = plugin::lock_beside(scene_file);
  if (fs::exists(lock)) all["lock"] = sha256(lock);
  return sha256_of(all.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string directory_name(const std::string& fingerprint) { return fingerprint.substr(0, 16); }

}  // namespace rouleau::trial
