#include "catalog.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "base/installation.hpp"
#include "base/synonyms.hpp"
#include "base/text.hpp"
#include "json/document.hpp"
#include "manifest_reader.hpp"
#include "scene/dimension_words.hpp"
#include "trust.hpp"

namespace rouleau::plugin {

namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

void require_folder(const fs::path& folder, const char* origin) {
  if (is_folder(folder)) return;
  std::error_code ignored;
  throw Error(Cause::bad_input, std::string(origin) + ": " + folder.string() +
                                    (fs::exists(folder, ignored) ? " is not a folder" : " does not exist"));
}

/// Folders of ROULEAU_PLUGIN_PATH. secure_getenv: a program with raised privileges does not trust its environment.
std::vector<fs::path> environment_folders() {
  std::vector<fs::path> folders;
  const char* variable = secure_getenv("ROULEAU_PLUGIN_PATH");
  std::string rest = variable == nullptr ? "" : variable;
  while (!rest.empty()) {
    const auto end = std::min(rest.find(':'), rest.size());
    const fs::path folder = rest.substr(0, end);
    rest.erase(0, std::min(end + 1, rest.size()));
    if (folder.empty()) continue;  // not the working directory, which an empty entry means in PATH
    if (folder.is_relative()) {
      throw Error(Cause::bad_input, "ROULEAU_PLUGIN_PATH holds the relative folder " + in_quotes(folder.string()) +
                                        "; its folders must be absolute, separated by ':'");
    }
    folders.push_back(folder);
  }
  return folders;
}

/// An environment variable's absolute folder, or nothing.
fs::path absolute_folder(const char* variable) {
  const char* value = secure_getenv(variable);
  const fs::path folder = value == nullptr ? "" : value;
  return folder.is_absolute() ? folder : fs::path();
}

/// The plugins that are installed, or built, with this code.
std::vector<fs::path> installed_folders() {
  std::vector<fs::path> folders;
  for (const fs::path& libraries : installation().libraries) folders.push_back(libraries / "rouleau" / "plugins");
  return folders;
}

/// A library that is not there, or lies elsewhere, is refused when it is opened.
void require_trust(const fs::path& manifest, const fs::path& open_folder, const fs::path& library) {
  const fs::path open = !open_folder.empty()
                            ? open_folder
                            : open_to_others({manifest, true_folder(manifest), library, true_folder(library)});
  if (open.empty()) return;
  throw Error(Cause::plugin_refused, Place{manifest.string()}, why_not_trusted(open));
}

std::string names_of(const std::vector<fs::path>& files) {
  std::string text;
  for (const auto& file : files) text += "\n    " + file.string();
  return text.empty() ? "\n    none" : text;
}

}  // namespace

bool is_below(const fs::path& file, const fs::path& folder) {
  const auto [left, right] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return left == folder.end() || (left->empty() && std::next(left) == folder.end());
}

std::vector<fs::path> named_folders(const std::vector<fs::path>& given) {
  for (const auto& folder : given) require_folder(folder, "folder of plugins");
  return given;
}

bool scenes_may_bring_plugins() {
  const char* value = std::getenv("ROULEAU_SCENE_PLUGINS");
  const std::string word = value == nullptr || *value == '\0' ? "yes" : value;
  if (word == "yes" || word == "no") return word == "yes";
  throw Error(Cause::bad_input, "the environment variable ROULEAU_SCENE_PLUGINS is " + in_quotes(word),
              {"it can be yes or no: whether plugins are looked for in folders that a scene names"});
}

fs::path user_plugin_folder() {
  fs::path data = absolute_folder("XDG_DATA_HOME");
  if (data.empty()) {
    const fs::path home = absolute_folder("HOME");
    if (home.empty()) return {};
    data = home / ".local" / "share";
  }
  return data / "rouleau" / "plugins";
}

std::string origin_of(const fs::path& file, const std::vector<fs::path>& named) {
  const auto in = [&](const std::vector<fs::path>& folders) {
    return std::any_of(folders.begin(), folders.end(), [&](const fs::path& folder) { return is_below(file, folder); });
  };
  if (in(named)) return "named";
  if (in(environment_folders())) return "environment";
  if (const fs::path user = user_plugin_folder(); !user.empty() && in({user})) return "user";
  return in(installed_folders()) ? "installation" : "named";
}

std::vector<fs::path> plugin_search_path(const std::vector<fs::path>& given, const std::vector<fs::path>& scene) {
  std::vector<fs::path> path = named_folders(given);
  for (const auto& folder : scenes_may_bring_plugins() ? scene : std::vector<fs::path>{}) {
    require_folder(folder, "plugin_dirs of the scene");
    path.push_back(folder);
  }
  for (const auto& folder : environment_folders())
    if (is_folder(folder)) path.push_back(folder);
  if (const fs::path folder = user_plugin_folder(); !folder.empty() && is_folder(folder)) path.push_back(folder);
  for (const auto& folder : installed_folders())
    if (is_folder(folder)) path.push_back(folder);
  return path;
}

Catalog::Catalog(const std::vector<fs::path>& folders) : folders_(folders) {
  const FoundFiles found = find_json_files(folders);
  for (const auto& [place, reason] : found.unreadable) refused_.push_back({place, {}, reason});
  const units::Units units;
  for (const auto& [file, open_folder] : found.files) {
    std::string id;
    try {
      const json::Document document = read_manifest_document(file);
      const auto& root = document.root();
      // A manifest whose first key is damaged shall be told of, and not pass for some other JSON file.
      const bool resembles = root.is_object() && root.contains("abi") && root.contains("library");
      if (!resembles && !(root.is_object() && root.contains("manifest"))) continue;
      if (root.contains("id") && root["id"].is_string()) id = root["id"];
      Manifest manifest = read_manifest(document, file, units);
      require_trust(file, open_folder, manifest.library);
      manifests_.push_back(std::move(manifest));
    } catch (const Error& error) {
      refused_.push_back({file, id, error.what()});
    }
  }
  refuse_duplicates();
}

/// A refused manifest counts too: if it is meant to replace the other one, that one must not be used in its stead.
void Catalog::refuse_duplicates() {
  std::map<std::string, std::vector<fs::path>> files;
  for (const auto& manifest : manifests_) files[manifest.id].push_back(manifest.file);
  for (const auto& refused : refused_)
    if (!refused.id.empty()) files[refused.id].push_back(refused.file);
  std::vector<Manifest> unique;
  for (auto& manifest : manifests_) {
    const auto& claimants = files[manifest.id];
    if (claimants.size() == 1) {
      unique.push_back(std::move(manifest));
    } else {
      refused_.push_back({manifest.file, manifest.id,
                          "  " + std::to_string(claimants.size()) + " manifests have the id " + in_quotes(manifest.id) +
                              ':' + names_of(claimants) +
                              "\n  take all but one of their folders off the search path, or give a model another id"});
    }
  }
  manifests_ = std::move(unique);
}

const Manifest& Catalog::find(ModelKind kind, const std::string& id, const Place& place,
                              std::optional<int> dimension) const {
  for (const auto& manifest : manifests_) {
    if (manifest.id != id) continue;
    if (manifest.kind == kind) {
      if (lock_) require_locked(*lock_, manifest, place);
      if (dimension && !manifest.works_in(*dimension)) {
        throw Error(Cause::bad_input, place,
                    in_quotes(id) + " (" + manifest.title + ") does not work in " + scene::words_of(*dimension).number +
                        " dimensions; of this kind there do: " + listed(ids(kind, dimension)));
      }
      return manifest;
    }
    throw Error(Cause::bad_input, place,
                in_quotes(id) + " is a plugin of the kind " + to_string(manifest.kind) + "; here one of the kind " +
                    to_string(kind) + " is wanted: " + listed(ids(kind)));
  }
  std::string reasons;
  for (const auto& refused : refused_) {
    // Each of two manifests with one id was refused for the other's sake: naming both once is enough.
    if (refused.id == id && reasons.find(refused.reason) == std::string::npos) reasons += "\n" + refused.reason;
  }
  if (!reasons.empty())
    throw Error(Cause::plugin_refused, place, "the plugin " + in_quotes(id) + " was refused:" + reasons);
  throw_unknown(kind, id, place);
}

void Catalog::throw_unknown(ModelKind kind, const std::string& id, const Place& place) const {
  std::string problem = "no plugin has the id " + in_quotes(id) + did_you_mean(id, ids(kind)) + "\n  of the kind " +
                        to_string(kind) + " there are: " + listed(ids(kind)) +
                        "\n  folders searched:" + names_of(folders_);
  if (!scenes_may_bring_plugins())
    problem += "\n  not searched: what a scene names in plugin_dirs (ROULEAU_SCENE_PLUGINS is no)";
  std::vector<fs::path> nameless;
  for (const auto& refused : refused_)
    if (refused.id.empty()) nameless.push_back(refused.file);
  if (!nameless.empty()) problem += "\n  could not be read:" + names_of(nameless);
  throw Error(Cause::bad_input, place, problem);
}

void Catalog::set_lock(Lock lock) {
  for (Manifest& manifest : manifests_) {
    const LockedPlugin* locked = lock.find(manifest.id);
    if (locked != nullptr) manifest.locked = {lock.file.string(), lock.renewal, locked->library_sha256};
  }
  lock_ = std::move(lock);
}

std::vector<std::string> Catalog::ids(ModelKind kind, std::optional<int> dimension) const {
  std::vector<std::string> names;
  for (const auto& manifest : manifests_)
    if (manifest.kind == kind && (!dimension || manifest.works_in(*dimension))) names.push_back(manifest.id);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace rouleau::plugin
