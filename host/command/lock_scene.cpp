#include "lock_scene.hpp"

#include <algorithm>
#include <iostream>

#include "input/scene.hpp"
#include "output/run_directory.hpp"
#include "plugin/catalog.hpp"
#include "plugin/lock.hpp"

namespace rouleau::host {

namespace {

/// Every plugin that a scene names, once, whether its parameters let it act or not.
std::vector<const Manifest*> named_plugins(const Scene& scene, const Catalog& catalog) {
  std::vector<const Manifest*> named;
  const auto add = [&](ModelKind kind, const ModelChoice& choice) {
    const Manifest& manifest = catalog.find(kind, choice.model, scene.place(choice.pointer + "/model"));
    if (std::find(named.begin(), named.end(), &manifest) == named.end()) named.push_back(&manifest);
  };
  add(ModelKind::collision, scene.fluid.collision);
  for (const CellType& type : scene.cell_types) {
    for (const ModelChoice& law : type.membrane) add(ModelKind::membrane, law);
  }
  for (const Interaction& interaction : scene.interactions) add(ModelKind::interaction, interaction.potential);
  return named;
}

}  // namespace

void lock_scene(const std::filesystem::path& scene_file, const std::vector<std::filesystem::path>& plugin_dirs,
                const std::filesystem::path& out) {
  const Scene scene = read_scene(scene_file);
  const Catalog catalog(plugin_search_path(plugin_dirs, scene.plugin_dirs));
  std::vector<LockedPlugin> locked;
  for (const Manifest* manifest : named_plugins(scene, catalog)) locked.push_back(lock_plugin(*manifest));
  const std::filesystem::path file = out.empty() ? lock_beside(scene_file) : out;
  write_file(file, lock_text(locked));
  std::cout << file.string() << '\n';
  for (const LockedPlugin& plugin : locked) {
    std::cout << "  " << plugin.kind << ' ' << plugin.id << ' ' << plugin.version << "  " << plugin.library_sha256
              << '\n';
  }
}

}  // namespace rouleau::host
