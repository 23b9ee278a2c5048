// The way of `rouleau plan`, for targets: from a scene's text to the printed plan.
#pragma once

#include <algorithm>

#include "core/membrane/membranes.hpp"
#include "plan/placed_cells.hpp"
#include "plan/plan_report.hpp"
#include "plan/read_scene.hpp"
#include "shape/random_cells.hpp"
#include "target.hpp"

namespace rouleau::fuzz {

/// The shipped plugins, as built beside the program.
inline const plugin::Catalog& shipped_catalog() {
  static const plugin::Catalog catalog({ROULEAU_PLUGINS});
  return catalog;
}

/// Work that a scene may rightly ask for is bounded by time, not here: a thousand cells at random take minutes, and a
/// million membrane nodes a second. Targets look at small scenes only, which reach the same lines.
inline bool is_small(const scene::Scene& scene) {
  constexpr int most_cells = 200, most_packed = 8;
  constexpr long most_membrane_nodes = 20'000;
  long nodes = 0;
  const auto nodes_of = [](const scene::CellType& type) { return type.segments + type.triangles / 2; };
  for (const auto& type : scene.cell_types) nodes += nodes_of(type);
  for (const auto& cell : scene.cells) nodes += nodes_of(scene.cell_types[static_cast<std::size_t>(cell.type)]);
  int packed = 0;
  for (const auto& packing : scene.packings) packed += packing.count;
  return scene.cells.size() <= most_cells && packed <= most_packed && nodes <= most_membrane_nodes;
}

/// `rouleau plan FILE --set ...`, but for the scene's own plugin_dirs.
inline void plan_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {}) {
  may_refuse([&] {
    auto [scene, numerics_choice] = plan::read_unpacked_scene(file, overrides);
    if (!is_small(scene)) return;
    shape::pack_cells(scene);
    const auto plan = plan::make_plan(scene, shipped_catalog(), numerics_choice);
    if (plan.has_cells) plan::try_cells(scene);
    const auto report = plan::make_report(plan);
    require_printable(plan::to_text(plan, report));
    plan::to_json(plan, report).dump();
  });
}

/// Ids of the plugins and names of their parameters and choices.
inline std::vector<std::string> plugin_words() {
  std::vector<std::string> words;
  for (const auto& manifest : shipped_catalog().manifests()) {
    words.push_back(manifest.id);
    for (const auto& parameter : manifest.parameters) {
      words.push_back(parameter.name);
      words.insert(words.end(), parameter.choices.begin(), parameter.choices.end());
    }
  }
  if (words.empty()) throw std::runtime_error("no plugins in " ROULEAU_PLUGINS);
  return words;
}

}  // namespace rouleau::fuzz
