// Cells at random: what the scene asks for, and their places.
#include "base/text.hpp"
#include "scene_reader.hpp"
#include "shape/packing.hpp"

namespace rouleau::scene {
namespace {

std::string percent(double share) { return number(100 * share, 4) + " %"; }

/// The region as written; the whole domain without one.
void read_region(const SceneFields& fields, const std::string& pointer, const Domain& domain, RandomPacking& packing) {
  packing.lower = Eigen::Vector2d::Zero();
  packing.upper = domain.size;
  if (!fields.has(pointer)) return;
  packing.lower = fields.quantities(pointer + "/lower", "m", range::place);
  packing.upper = fields.quantities(pointer + "/upper", "m", range::place);
  for (int axis = 0; axis < 2; ++axis) {
    const std::string along = axis == 0 ? "x" : "y", name = axis == 0 ? "/0" : "/1";
    if (packing.lower[axis] < 0) fields.refuse(pointer + "/lower" + name, "the region begins outside of the domain");
    // A size that was written in other units may differ by rounding.
    if (packing.upper[axis] > domain.size[axis] * (1 + 1e-9)) {
      fields.refuse(pointer + "/upper" + name, "the region ends outside of the domain, whose size along " + along +
                                                   " is " + number(domain.size[axis] * 1e6) + " um");
    }
    if (!(packing.upper[axis] > packing.lower[axis])) {
      fields.refuse(pointer + "/upper" + name,
                    "the region's upper corner must lie above its lower corner along " + along);
    }
  }
}

/// Refuses what is hopeless before it is tried: pack() takes its time, and looks at every periodic image that is near.
void check_lengths(const SceneFields& fields, const RandomPacking& packing, const CellType& type) {
  const double across = (packing.upper - packing.lower).norm(), length = 2 * shape::largest_radius(type.shape);
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
  if (packing.reached > 1) {
    fields.refuse(packing.pointer + "/random", "these " + std::to_string(packing.count) + " cells would fill " +
                                                   percent(packing.reached) +
                                                   " of the region\nask for fewer cells, or a larger region");
  }
}

}  // namespace

RandomPacking read_packing(const SceneFields& fields, const std::string& entry, int type,
                           const std::vector<CellType>& types, const Domain& domain) {
  const auto pointer = entry + "/random";
  const CellType& cell_type = types[static_cast<std::size_t>(type)];
  RandomPacking packing{};
  packing.type = type;
  packing.pointer = entry;
  packing.seed = fields.at(pointer + "/seed").get<std::uint32_t>();
  packing.gap = fields.quantity_or(pointer + "/gap", "m", range::length, domain.size.x() / domain.nodes[0]);
  read_region(fields, pointer + "/region", domain, packing);

  const bool by_share = fields.has(pointer + "/hematocrit"), by_count = fields.has(pointer + "/count");
  if (by_share == by_count) {
    fields.refuse(pointer, by_share ? "give hematocrit or count, not both"
                                    : "give hematocrit (such as 0.3) or count (such as 20)");
  }
  if (by_count) {
    packing.count = fields.at(pointer + "/count").get<int>();
  } else {
    packing.hematocrit = fields.at(pointer + "/hematocrit").get<double>();
    const double count = shape::cells_for(*packing.hematocrit, cell_type, packing);
    if (count < 1) {
      fields.refuse(pointer + "/hematocrit",
                    "that is less than half a cell in this region; ask for more, for a "
                    "larger region, or for a count");
    }
    if (count > static_cast<double>(most_cells)) {
      fields.refuse(pointer + "/hematocrit", "that would be " + number(count, 12) + " cells; at most " +
                                                 std::to_string(most_cells) + " can be computed");
    }
    packing.count = static_cast<int>(count);
  }
  packing.reached = shape::hematocrit_of(packing, cell_type);
  check_lengths(fields, packing, cell_type);
  return packing;
}

void pack_cells(Scene& scene) {
  if (scene.packings.empty()) return;
  const double across = scene.domain.size.norm();
  for (const CellPlacement& cell : scene.cells) {
    const CellType& type = scene.cell_types[static_cast<std::size_t>(cell.type)];
    if (2 * shape::largest_radius(type.shape) <= across) continue;
    SceneFields(*scene.document)
        .refuse(cell.pointer, "a cell of the type " + type.name + " is " +
                                  number(2e6 * shape::largest_radius(type.shape)) + " um long, but the domain is " +
                                  number(across * 1e6) +
                                  " um from corner to corner\ntake a smaller cell or a larger domain");
  }
  const auto shortfall = shape::pack(scene.domain, scene.cell_types, scene.packings, scene.cells);
  if (!shortfall) return;
  const RandomPacking& packing = scene.packings[shortfall->packing];
  SceneFields(*scene.document)
      .refuse(packing.pointer + "/random",
              "these " + std::to_string(packing.count) + " cells, " + percent(packing.reached) +
                  " of the region, do not fit without overlap: moving and turning them came to a standstill at " +
                  percent(shortfall->hematocrit) + "\nask for fewer cells, a gap smaller than " +
                  number(packing.gap * 1e6, 3) + " um, or a larger region");
}

}  // namespace rouleau::scene
