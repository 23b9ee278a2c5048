#include "lock_scene.hpp"

#include <algorithm>
#include <iostream>

#include "command/process/command_line.hpp"
#include "files/file.hpp"
#include "files/run_directory.hpp"
#include "plan/read_scene.hpp"
#include "plugin/lock.hpp"

namespace rouleau::command {

namespace {

/// Every plugin that a scene names, once, whether its parameters let it act or not.
std::vector<const plugin::Manifest*> named_plugins(const scene::Scene& scene, const plugin::Catalog& catalog) {
  std::vector<const plugin::Manifest*> named;
  const auto add = [&](plugin::ModelKind kind, const scene::ModelChoice& choice) {
    const plugin::Manifest& manifest = catalog.find(kind, choice.model, scene.place(choice.pointer + "/model"));
    if (std::find(named.begin(), named.end(), &manifest) == named.end()) named.push_back(&manifest);
  };
  add(plugin::ModelKind::collision, scene.fluid.collision);
  for (const scene::CellType& type : scene.cell_types) {
    for (const scene::ModelChoice& law : type.membrane) add(plugin::ModelKind::membrane, law);
  }
  for (const scene::Interaction& interaction : scene.interactions)
    add(plugin::ModelKind::interaction, interaction.potential);
  return named;
}

}  // namespace

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
