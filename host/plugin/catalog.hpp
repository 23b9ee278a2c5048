// All manifests that the search path offers. Reads JSON only: no library is opened here.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "lock.hpp"
#include "manifest.hpp"

namespace rouleau::plugin {

/// Folders to search, first to last: those given, the scene's plugin_dirs, ROULEAU_PLUGIN_PATH (secure_getenv, ':'
/// separated), the user's own folder, base/installation.hpp. Never the working directory. Entries that do not exist are
/// left out, except those given and those of the scene: they must exist (Error bad_input). Those of the scene are left
/// out where scenes_may_bring_plugins() says so.
std::vector<std::filesystem::path> plugin_search_path(const std::vector<std::filesystem::path>& given,
                                                      const std::vector<std::filesystem::path>& scene);

/// Whether a scene may bring code along: not where ROULEAU_SCENE_PLUGINS is "no". Throws Error(bad_input) for what is
/// neither "no" nor "yes".
bool scenes_may_bring_plugins();

/// Folders that somebody names, which must exist (Error bad_input), and no others.
std::vector<std::filesystem::path> named_folders(const std::vector<std::filesystem::path>& given);

/// The user's own folder, whether it exists or not: rouleau/plugins in XDG_DATA_HOME or else in HOME/.local/share.
/// Empty where there is none: variables that are unset or no absolute folders, a program with raised privileges.
std::filesystem::path user_plugin_folder();

/// Whether the name of a file leads through a folder.
bool is_below(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Why a file is on the search path: "user" of the user's own folder, "environment" of ROULEAU_PLUGIN_PATH,
/// "installation" of what was installed with this code; "named" where an option or a scene names its folder. Of several
/// the first in the order of the search.
std::string origin_of(const std::filesystem::path& file, const std::vector<std::filesystem::path>& named);

class Catalog {
 public:
  /// A manifest that cannot be used, and why. Listed by `rouleau plugins`; an error only when a scene names its id.
  struct Refused {
    std::filesystem::path file;
    std::string id;  ///< empty when not even that could be read
    std::string reason;
  };

  /// Searches each folder and its sub-folders for *.json files with a "manifest" key (or, should that be
  /// damaged, with "abi" and "library"). Refuses those that every user of
  /// the machine could have written or replaced: they, their library, or a folder from theirs up to the searched one is
  /// writable by others.
  explicit Catalog(const std::vector<std::filesystem::path>& folders);

  /// From now on only what the lock holds is found, and libraries that differ from it are not opened.
  void set_lock(Lock lock);
  [[nodiscard]] const std::optional<Lock>& lock() const { return lock_; }

  [[nodiscard]] const std::vector<Manifest>& manifests() const { return manifests_; }
  [[nodiscard]] const std::vector<Refused>& refused() const { return refused_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& folders() const { return folders_; }

  /// Manifest of a model. Throws Error(bad_input) at `place` for an id that nobody offers (nearest name, folders
  /// searched) or that is of another kind; Error(plugin_refused) for a refused manifest, two manifests with this id,
  /// or one that differs from the lock. With a `dimension`, that of a scene, Error(bad_input) for a model that does not
  /// work in it.
  [[nodiscard]] const Manifest& find(ModelKind kind, const std::string& id, const Place& place,
                                     std::optional<int> dimension = {}) const;

  /// Ids of the usable models of a kind (and of a dimension), sorted.
  [[nodiscard]] std::vector<std::string> ids(ModelKind kind, std::optional<int> dimension = {}) const;

 private:
  void refuse_duplicates();
  [[noreturn]] void throw_unknown(ModelKind kind, const std::string& id, const Place& place) const;

  std::vector<std::filesystem::path> folders_;
  std::vector<Manifest> manifests_;
  std::vector<Refused> refused_;
  std::optional<Lock> lock_;
};

}  // namespace rouleau::plugin
