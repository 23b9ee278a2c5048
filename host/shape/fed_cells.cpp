#include "fed_cells.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.hpp"
#include "extent.hpp"
#include "scene/scene_reader.hpp"

namespace rouleau::shape {
namespace {

double duration_of(const scene::Scene& scene) {
  double sum = 0;
  for (const scene::Stage& stage : scene.stages) sum += stage.duration.value_or(0);
  return sum;
}

/// How many cells come in each second through an inlet of this area, m2, or m in two dimensions.
double arrivals(const scene::Scene& scene, const scene::Feed& feed, double area) {
  return feed.hematocrit * *scene.domain.openings->front().mean_velocity * area /
         enclosed_by(scene.cell_types[feed.type]);
}

}  // namespace

void add_fed_cells(scene::Scene& scene) {
  if (scene.domain.feed() == nullptr) return;
  const scene::Feed& feed = *scene.domain.feed();
  const double area = scene.domain.size.product() / scene.domain.size.x();  // all of the end is open at most
  const double most = std::ceil(arrivals(scene, feed, area) * duration_of(scene)) + 1;
  const scene::SceneFields fields(*scene.document);
  if (!(most <= static_cast<double>(scene::most_cells))) {
    fields.refuse(feed.pointer, "about " + number(most, 3) + " cells would come in during the stages; at most " +
                                    std::to_string(scene::most_cells) +
                                    " can be computed\nmake the stages shorter, or the hematocrit smaller");
  }
  scene.fed = static_cast<std::size_t>(most);
  fields.require_room(scene.cells.size(), scene.fed, feed.pointer);
  scene.cells.insert(scene.cells.end(), scene.fed, {feed.type, 0.5 * scene.domain.size, 0, feed.pointer});
  scene::check_membrane_nodes(scene);
}

std::span<const scene::CellPlacement> cells_at_once(const scene::Scene& scene) {
  const scene::Feed* const feed = scene.domain.feed();
  if (feed == nullptr) return scene.cells;
  const double fed = std::ceil(feed->hematocrit * scene.domain.content() / enclosed_by(scene.cell_types[feed->type]));
  const auto come = static_cast<std::size_t>(std::min(fed, static_cast<double>(scene.fed)));
  return {scene.cells.data(), scene.placed().size() + come};
}

}  // namespace rouleau::shape
