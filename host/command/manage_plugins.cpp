#include "manage_plugins.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <iostream>

#include "base/process.hpp"
#include "base/text.hpp"
#include "command/process/command_line.hpp"
#include "commands.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "plan/read_scene.hpp"
#include "plugin/library.hpp"
#include "plugin/lock.hpp"

namespace rouleau::command {

namespace {

namespace fs = std::filesystem;

/// The plugins of a folder that is searched for nothing else.
std::vector<plugin::Manifest> plugins_in(const fs::path& folder) {
  const plugin::Catalog offered(plugin::named_folders({folder}));
  for (const auto& refused : offered.refused())
    throw Error(Cause::plugin_refused, Place{refused.file.string()}, refused.reason);
  if (offered.manifests().empty()) {
    throw Error(Cause::bad_input, Place{folder.string()},
                "holds no manifest of a plugin; name the folder with the built library and its manifest");
  }
  return offered.manifests();
}

void require_conformance(const std::vector<plugin::Manifest>& manifests) {
  constexpr double longest_s = 3600;  // each check has a time limit of its own
  for (const plugin::Manifest& manifest : manifests) {
    const std::string file = manifest.file.string();
    const ProcessEnd end = run_process(conform_program(), {fs::absolute(file), "--level", "interface"}, longest_s);
    if (end.exit_code == exit_code::done && end.signal == 0 && !end.timed_out) continue;
    throw Error(Cause::plugin_refused, Place{file},
                "the plugin does not keep to the interface, and is not installed\n  rouleau conform " + in_shell(file) +
                    " --level interface says where");
  }
}

/// A plugin in a folder of its own beside the user's, to be moved there.
class Prepared {
 public:
  Prepared(const plugin::Manifest& manifest, const fs::path& user_folder)
      : place_(user_folder / manifest.id),
        partial_(user_folder.parent_path() / ('.' + manifest.id + '.' + std::to_string(::getpid()) + ".partial")) {
    std::error_code error;
    fs::remove_all(partial_, error);
    if (!fs::create_directory(partial_, error)) fail(error ? error.value() : EEXIST);
    const fs::path library = partial_ / manifest.library.filename();
    files::write_file(library, files::read_text(plugin::checked_library(manifest)));
    files::write_file(partial_ / manifest.file.filename(), files::read_text(manifest.file));
    for (const fs::path& path : {partial_, library, partial_ / manifest.file.filename()})
      fs::permissions(path, fs::perms::others_write, fs::perm_options::remove, error);
    files::synchronise(partial_);
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;
  ~Prepared() {
    std::error_code ignored;
    fs::remove_all(partial_, ignored);
  }

  /// In one step; what was there before is taken away after it.
  void move_into_place() const {
    const bool replaces = fs::exists(fs::symlink_status(place_));
    const unsigned how = replaces ? RENAME_EXCHANGE : RENAME_NOREPLACE;
    if (::renameat2(AT_FDCWD, partial_.c_str(), AT_FDCWD, place_.c_str(), how) != 0) fail(errno);
    files::synchronise(place_.parent_path());
  }
  [[nodiscard]] const fs::path& place() const { return place_; }

 private:
  [[noreturn]] void fail(int error) const { fail_file(place_, "cannot be installed", error); }

  fs::path place_, partial_;
};

void require_free(const plugin::Manifest& manifest, const fs::path& place, const plugin::Catalog& catalog,
                  bool overwrite) {
  if (!overwrite && fs::exists(fs::symlink_status(place))) {
    throw Error(Cause::bad_input, Place{place.string()},
                "there is " + in_quotes(manifest.id) + " already; --overwrite replaces it");
  }
  for (const plugin::Manifest& other : catalog.manifests()) {
    if (other.id != manifest.id || other.file.parent_path() == place) continue;
    throw Error(Cause::bad_input, Place{manifest.file.string()},
                in_quotes(manifest.id) + " is the id of " + other.file.string() +
                    ", too, and of two plugins with one id none can be used; give yours another id");
  }
}

/// Every plugin that a scene names, once, whether its parameters let it act or not.
std::vector<const plugin::Manifest*> named_plugins(const scene::Scene& scene, const plugin::Catalog& catalog) {
  std::vector<const plugin::Manifest*> named;
  const auto add = [&](plugin::ModelKind kind, const scene::ModelChoice& choice) {
    const plugin::Manifest& manifest = catalog.find(kind, choice.model, scene.place(choice.pointer + "/model"));
    if (std::find(named.begin(), named.end(), &manifest) == named.end()) named.push_back(&manifest);
  };
  add(plugin::ModelKind::collision, scene.fluid.collision);
  for (const scene::CellType& type : scene.cell_types)
    for (const scene::ModelChoice& law : type.membrane) add(plugin::ModelKind::membrane, law);
  for (const scene::Interaction& interaction : scene.interactions)
    add(plugin::ModelKind::interaction, interaction.potential);
  return named;
}

}  // namespace

void install_plugins(const fs::path& folder, const plugin::Catalog& catalog, bool overwrite) {
  const fs::path user_folder = plugin::user_plugin_folder();
  if (user_folder.empty()) {
    throw Error(Cause::bad_input,
                "rouleau plugins --install: there is no folder to install into; set HOME, or XDG_DATA_HOME to an "
                "absolute folder");
  }
  const std::vector<plugin::Manifest> manifests = plugins_in(folder);
  for (const plugin::Manifest& manifest : manifests)
    require_free(manifest, user_folder / manifest.id, catalog, overwrite);
  require_conformance(manifests);
  std::vector<std::unique_ptr<Prepared>> prepared;
  prepared.reserve(manifests.size());
  try {
    std::error_code error;
    fs::create_directories(user_folder, error);
    if (error) fail_file(user_folder, "cannot be made", error.value());
    for (const plugin::Manifest& manifest : manifests)
      prepared.push_back(std::make_unique<Prepared>(manifest, user_folder));
  } catch (const Error& fault) {
    if (fault.cause() != Cause::input_output) throw;
    throw Error(fault.cause(), fault.place(), fault.problem(),
                {"set XDG_DATA_HOME to a folder that you may write to, or leave the plugin where it is and name its "
                 "folder with --plugin-dir"});
  }
  for (std::size_t i = 0; i < manifests.size(); ++i) {
    prepared[i]->move_into_place();
    std::cout << plugin::to_string(manifests[i].kind) << ' ' << manifests[i].id << ' ' << manifests[i].version << "\n  "
              << prepared[i]->place().string() << '\n';
  }
}

void lock_scene(const std::filesystem::path& scene_file, const std::vector<std::filesystem::path>& plugin_dirs,
                const std::filesystem::path& out) {
  const scene::Scene scene = plan::read_unpacked_scene(scene_file).scene;
  const plugin::Catalog catalog(plugin::plugin_search_path(plugin_dirs, scene.plugin_dirs));
  std::vector<plugin::LockedPlugin> locked;
  for (const plugin::Manifest* manifest : named_plugins(scene, catalog))
    locked.push_back(plugin::lock_plugin(*manifest));
  const std::filesystem::path file = out.empty() ? plugin::lock_beside(scene_file) : out;
  files::write_file(file, plugin::lock_text(locked));
  std::cout << file.string() << '\n';
  for (const plugin::LockedPlugin& plugin : locked) {
    std::cout << "  " << plugin.kind << ' ' << plugin.id << ' ' << plugin.version << "  " << plugin.library_sha256
              << '\n';
  }
}

std::string lock_renewal(const std::filesystem::path& lock, const std::filesystem::path& scene) {
  return "if this is meant, lock the scene again: rouleau plugins --lock " + in_shell(scene.string()) +
         (lock == plugin::lock_beside(scene) ? "" : " --out " + in_shell(lock.string()));
}

}  // namespace rouleau::command
