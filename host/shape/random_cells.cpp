#include "random_cells.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.hpp"
#include "extent.hpp"
#include "scene/driving_flow.hpp"
#include "scene/scene_reader.hpp"

namespace rouleau::shape {

namespace {

std::string percent(double share) { return number(100 * share, 4) + " %"; }

/// How many cells of this type fill the share of the region that is asked for.
int count_for_share(const scene::SceneFields& fields, const scene::RandomPacking& packing, const scene::CellType& type,
                    const scene::Domain& domain) {
  const auto pointer = packing.pointer + "/random/hematocrit";
  const double count = cells_for(*packing.hematocrit, type, packing, domain);
  if (count < 1) {
    fields.refuse(pointer,
                  "that is less than half a cell in this region; ask for more, for a "
                  "larger region, or for a count");
  }
  if (count > static_cast<double>(scene::most_cells)) {
    fields.refuse(pointer, "that would be " + number(count, 12) + " cells; at most " +
                               std::to_string(scene::most_cells) + " can be computed");
  }
  return static_cast<int>(count);
}

/// Refuses what is hopeless before it is tried: pack() takes its time, and looks at every periodic image that is near.
void check_lengths(const scene::SceneFields& fields, const scene::RandomPacking& packing, const scene::CellType& type) {
  const double across = (packing.upper - packing.lower).norm();
  const double length = 2 * shape_radius(type.shape);
  const auto micrometres = [](double metres) { return number(metres * 1e6) + " um"; };
  const auto room = micrometres(across) + " from corner to corner";
  if (length > across) {
    fields.refuse(packing.pointer + "/random", "a cell of the type " + type.name + " is " + micrometres(length) +
                                                   " long, but its region is " + room +
                                                   "\ntake a smaller cell or a larger region");
  }
  if (packing.gap > across) {
    fields.refuse(packing.pointer + "/random/gap", "no two cells can be " + micrometres(packing.gap) +
                                                       " apart in a region that is " + room + "; take a smaller gap");
  }
  if (std::isinf(packing.reached))
    fields.refuse(packing.pointer + "/random", "no fluid lies in the region of these cells; move it");
  if (packing.reached > 1) {
    fields.refuse(packing.pointer + "/random", "these " + std::to_string(packing.count) + " cells would fill " +
                                                   percent(packing.reached) +
                                                   " of the region\nask for fewer cells, or a larger region");
  }
}

double duration_of(const scene::Scene& scene) {
  double sum = 0;
  for (const scene::Stage& stage : scene.stages) sum += stage.duration.value_or(0);
  return sum;
}

/// How many cells come in each second at most. Between two pressures, where all of the domain were as wide as at its
/// widest place, and as fast as the fluid is in the middle.
double arrivals(const scene::Scene& scene, const scene::Feed& feed) {
  const double area =
      scene.domain.size.product() / scene.domain.size[scene.domain.open_axis];  // all of the end is open at most
  double velocity = 0;
  if (const auto& inlet = scene.domain.openings->front(); inlet.mean_velocity) {
    velocity = *inlet.mean_velocity;
  } else {
    const double height = scene::wall_distance(scene.domain);
    velocity = std::max(0.0, scene::opening_drive(scene)) * height * height / (8 * scene.fluid.viscosity);
  }
  return feed.hematocrit * velocity * area / enclosed_by(scene.cell_types[feed.type]);
}

}  // namespace

void add_random_cells(scene::Scene& scene) {
  if (scene.packings.empty()) return;
  const scene::SceneFields fields(*scene.document);
  int added = 0;
  for (scene::RandomPacking& packing : scene.packings) {
    const scene::CellType& type = scene.cell_types[packing.type];
    if (packing.hematocrit) packing.count = count_for_share(fields, packing, type, scene.domain);
    packing.reached = hematocrit_of(packing, type, scene.domain);
    check_lengths(fields, packing, type);
    fields.require_room(scene.cells.size(), static_cast<std::size_t>(packing.count), packing.pointer + "/random");
    packing.first += added;
    added += packing.count;
    const scene::Vector middle = 0.5 * (packing.lower + packing.upper);
    const auto first = scene.cells.insert(scene.cells.begin() + packing.first, static_cast<std::size_t>(packing.count),
                                          {packing.type, middle, 0, packing.pointer});
    // Until they are placed they stand for any cells of their region: at all heights of it.
    for (int i = 0; i < packing.count; ++i)
      first[i].center.y() = packing.lower.y() + (i + 0.5) / packing.count * (packing.upper.y() - packing.lower.y());
  }
  scene::check_membrane_nodes(scene);
}

void pack_cells(scene::Scene& scene, const PackingWatch& watch) {
  if (scene.packings.empty()) return;
  const double across = scene.domain.size.norm();
  for (const scene::CellPlacement& cell : scene.cells) {
    const scene::CellType& type = scene.cell_types[cell.type];
    if (2 * shape_radius(type.shape) <= across) continue;
    scene::SceneFields(*scene.document)
        .refuse(cell.pointer, "a cell of the type " + type.name + " is " + number(2e6 * shape_radius(type.shape)) +
                                  " um long, but the domain is " + number(across * 1e6) +
                                  " um from corner to corner\ntake a smaller cell or a larger domain");
  }
  // What comes in later is not in the way.
  const std::vector<scene::CellPlacement> fed(scene.cells.end() - static_cast<std::ptrdiff_t>(scene.fed),
                                              scene.cells.end());
  scene.cells.resize(scene.placed().size());
  const auto shortfall = pack(scene.domain, scene.cell_types, scene.packings, scene.cells, watch);
  scene.cells.insert(scene.cells.end(), fed.begin(), fed.end());
  if (!shortfall) return;
  const scene::RandomPacking& packing = scene.packings[shortfall->packing];
  scene::SceneFields(*scene.document)
      .refuse(packing.pointer + "/random",
              "these " + std::to_string(packing.count) + " cells, " + percent(packing.reached) +
                  " of the region, do not fit without overlap: moving and turning them came to a standstill at " +
                  percent(shortfall->hematocrit) + "\nask for fewer cells, a gap smaller than " +
                  number(packing.gap * 1e6, 3) + " um, or a larger region");
}

void add_fed_cells(scene::Scene& scene) {
  if (scene.domain.feed() == nullptr) return;
  const scene::Feed& feed = *scene.domain.feed();
  const double most = std::ceil(arrivals(scene, feed) * duration_of(scene)) + 1;
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
