#include "manifest_reader.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "json/schema.hpp"
#include "manifest_fields.hpp"
#include "trust.hpp"

namespace rouleau::plugin {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string text_of(const Json& object, const char* key) { return object.value(key, std::string()); }

std::vector<std::string> words_of(const Json& root, const char* key) {
  return root.value(key, std::vector<std::string>());
}

/// The author's own keys never reach the rest of the host.
Json without_own_keys(const Json& value) {
  if (!value.is_object()) return value;
  Json kept = Json::object();
  for (const auto& [key, member] : value.items())
    if (!key.starts_with("x-")) kept[key] = member;
  return kept;
}

std::vector<int> dimensions_of(const std::vector<std::string>& lattices) {
  std::vector<int> dimensions;
  dimensions.reserve(lattices.size());
  for (const std::string& lattice : lattices) dimensions.push_back(lattice == "D3Q19" ? 3 : 2);
  return dimensions;
}

ModelKind kind_of(const std::string& word) {
  if (word == "collision") return ModelKind::collision;
  if (word == "membrane") return ModelKind::membrane;
  return ModelKind::interaction;
}

class Search {
 public:
  FoundFiles found;

  void all_under(const fs::path& path) {
    searched_ = path;
    folders_ = 0;
    folder(path, {});
  }

 private:
  /// `open_above`: the first folder on the way here that every user may write to.
  void folder(const fs::path& path, const fs::path& open_above) {
    if (!is_new(path)) return;
    if (++folders_ > most_folders) {
      throw Error(Cause::bad_input, Place{searched_.string()},
                  "more than " + std::to_string(most_folders) +
                      " folders lie under this one, where plugins are looked for; name the folder that holds them");
    }
    const fs::path open = open_above.empty() ? open_to_others({path}) : open_above;
    std::vector<fs::path> files, folders;
    std::error_code error;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
      std::error_code status_error;
      const fs::file_status status = entry->status(status_error);
      if (fs::is_directory(status))
        folders.push_back(entry->path());
      else if (entry->path().extension() == ".json")
        if (fs::is_regular_file(status))
          files.push_back(entry->path());
        else
          refuse(entry->path(), status_error ? status_error.message() : "not a regular file");
      else if (entry->is_symlink() && status_error && status_error != std::errc::no_such_file_or_directory)
        refuse(entry->path(), status_error.message());  // a link to a folder that cannot be followed
    }
    if (error) refuse(path, error.message());
    std::sort(files.begin(), files.end());
    std::sort(folders.begin(), folders.end());
    for (const auto& file : files)
      if (is_new(file)) found.files.push_back({file, open});
    for (const auto& child : folders) folder(child, open);
  }

  bool is_new(const fs::path& path) {
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    if (error) {
      refuse(path, error.message());
      return false;
    }
    return seen_.insert(canonical).second;
  }

  void refuse(const fs::path& path, const std::string& reason) {
    found.unreadable.emplace_back(path, path.string() + "\n  cannot be read: " + reason);
  }

  static constexpr int most_folders = 10'000;
  fs::path searched_;
  int folders_ = 0;  ///< under it so far
  std::set<fs::path> seen_;
};

}  // namespace

json::Document read_manifest_document(const fs::path& file) {
  try {
    // Folders of plugins may hold data as well; reading all of it to find out that it is no manifest would take for
    // ever.
    return json::Document::parse(read_input(file, 1U << 20U), file.string(), Cause::plugin_refused);
  } catch (const Error& error) {
    throw Error(Cause::plugin_refused, error.place(), error.problem(), error.remedy());
  }
}

Manifest read_manifest(const json::Document& document, const fs::path& file, const units::Units& units) {
  json::validate(document, manifest_schema(), Cause::plugin_refused);
  const Json& root = document.root();

  Manifest manifest;
  manifest.file = file;
  manifest.sha256 = sha256_of(document.text());
  manifest.library = fs::absolute(file).parent_path() / text_of(root, "library");
  manifest.library_stamp = stamp_of(manifest.library);
  manifest.kind = kind_of(text_of(root, "kind"));
  manifest.id = text_of(root, "id");
  manifest.version = text_of(root, "version");
  manifest.title = text_of(root, "title");
  manifest.reference = text_of(root, "reference");
  manifest.author = text_of(root, "author");
  manifest.license = text_of(root, "license");
  manifest.parameters = read_parameters(document, units);
  manifest.needs = words_of(root, "needs");
  manifest.gives = words_of(root, "gives");
  manifest.state = read_state(document, units);
  manifest.inactive_when = without_own_keys(root.value("inactive_when", Json()));
  manifest.stands_for = without_own_keys(root.value("stands_for", Json()));
  manifest.claims = without_own_keys(root.value("claims", Json::object()));
  manifest.checks = root.value("checks", Json::array());
  // A potential is an energy per area, whatever the dimension, unless it wants to know in which direction surfaces
  // slide; older manifests do not say so.
  const bool of_both = manifest.kind == ModelKind::interaction && !manifest.needs_input("tangential_velocity");
  manifest.dimensions = root.value("dimensions", of_both ? std::vector{2, 3} : manifest.dimensions);
  if (root.contains("lattices")) manifest.dimensions = dimensions_of(words_of(root, "lattices"));
  if (root.contains("in_3d")) {
    const Json& surface = root["in_3d"];
    manifest.in_3d = {words_of(surface, "needs"), words_of(surface, "gives"), surface.value("checks", Json::array())};
  }
  check_roles(document, manifest);
  check_dimensions(document, manifest);
  check_quantities(document, manifest.in(manifest.dimension()), "");
  if (manifest.in_3d) check_quantities(document, manifest.in(3), "/in_3d");
  check_parameter_values(document, manifest, "inactive_when", manifest.inactive_when, units);
  check_parameter_values(document, manifest, "stands_for", manifest.stands_for, units);
  return manifest;
}

Manifest read_manifest(const fs::path& file, const units::Units& units) {
  return read_manifest(read_manifest_document(file), file, units);
}

FoundFiles find_json_files(const std::vector<fs::path>& folders) {
  Search search;
  for (const auto& folder : folders) search.all_under(folder);
  return std::move(search.found);
}

}  // namespace rouleau::plugin
