// A scene's lock: plugins of which somebody has written down what they were.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "json/json.hpp"
#include "manifest.hpp"

namespace rouleau::plugin {

struct LockedPlugin {
  std::string id, kind, version;
  std::string library_sha256, manifest_sha256;
};

struct Lock {
  std::filesystem::path file;  ///< the lock itself
  std::string renewal;         ///< how the user makes it anew: a remedy's words
  std::string sha256;          ///< of the lock
  std::vector<LockedPlugin> plugins;

  /// Null for a plugin that the lock does not hold.
  [[nodiscard]] const LockedPlugin* find(const std::string& id) const;
};

/// The lock that a run obeyed.
struct LockUse {
  std::string file, sha256;
  NLOHMANN_DEFINE_TYPE_INTRUSIVE(LockUse, file, sha256)
};

/// NAME.lock.json beside a scene NAME.json.
std::filesystem::path lock_beside(const std::filesystem::path& scene);

/// What a plugin is now. Throws Error(plugin_refused) when its library is not where it must be.
LockedPlugin lock_plugin(const Manifest& manifest);
/// Text of a lock, by kind and id.
std::string lock_text(std::vector<LockedPlugin> plugins);

/// The schema of a lock.
const nlohmann::json& lock_schema();
/// Throws Error(input_output) for a lock that cannot be read, Error(bad_input) with its place for a damaged one.
/// `renewal`: what to do when a plugin is meant to differ from it.
Lock read_lock(const std::filesystem::path& file, const std::string& renewal);

/// Throws Error(plugin_refused) at `place` of the scene for a plugin that the lock does not hold or whose kind, version
/// or manifest differ from it. Its library is compared when it is opened.
void require_locked(const Lock& lock, const Manifest& manifest, const Place& place);

}  // namespace rouleau::plugin
