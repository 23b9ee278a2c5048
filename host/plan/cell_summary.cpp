#include "cell_summary.hpp"

#include "shape/outline.hpp"

namespace rouleau::plan {

double hematocrit(const scene::Scene& scene) {
  std::vector<double> area;
  for (const scene::CellType& type : scene.cell_types)
    area.push_back(shape::area_of(shape::make_outline(type.shape, type.segments)));
  double sum = 0;
  for (const scene::CellPlacement& cell : scene.cells) sum += area[static_cast<std::size_t>(cell.type)];
  return sum / scene.domain.size.prod();
}

nlohmann::json packing_table(const scene::Scene& scene) {
  nlohmann::json table = nlohmann::json::array();
  for (const scene::RandomPacking& packing : scene.packings) {
    table.push_back({{"pointer", packing.pointer},
                     {"type", scene.cell_types[static_cast<std::size_t>(packing.type)].name},
                     {"cells", {packing.first, packing.first + packing.count - 1}},
                     {"count", packing.count},
                     {"hematocrit_asked", packing.hematocrit ? nlohmann::json(*packing.hematocrit) : nlohmann::json()},
                     {"hematocrit", packing.reached},
                     {"seed", packing.seed},
                     {"gap_m", packing.gap}});
  }
  return table;
}

}  // namespace rouleau::plan
