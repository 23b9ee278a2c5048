#include "cell_report.hpp"

#include "input/outline.hpp"

namespace rouleau::host {

double hematocrit(const Scene& scene) {
  std::vector<double> area;
  for (const CellType& type : scene.cell_types) area.push_back(area_of(make_outline(type.shape, type.segments)));
  double sum = 0;
  for (const CellPlacement& cell : scene.cells) sum += area[static_cast<std::size_t>(cell.type)];
  return sum / scene.domain.size.prod();
}

nlohmann::json packing_table(const Scene& scene) {
  nlohmann::json table = nlohmann::json::array();
  for (const RandomPacking& packing : scene.packings) {
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

}  // namespace rouleau::host
