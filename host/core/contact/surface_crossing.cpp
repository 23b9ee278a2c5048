#include "surface_crossing.hpp"

#include <tuple>
#include <vector>

#include "cell_grid.hpp"
#include "surface_patches.hpp"

namespace rouleau::core {

std::optional<SurfaceCrossing> find_crossing(const Surfaces& surfaces, const Domain<3>& domain) {
  constexpr double rounding = 1e-6;
  const std::vector<BoundingBox<3>> boxes = boxes_of_known<3>(surfaces);
  const CellGrid<3> grid(boxes, 0, domain);
  SurfacePatches patches(surfaces, domain);
  std::vector<std::vector<Vec<3>>> normals(surfaces.cells.size());  // of nodes; made where they are wanted
  std::optional<SurfaceCrossing> deepest;
  std::vector<int> near;
  const auto look = [&](int cell, int node, int other, const Vec<3>& place) {
    const auto point = patches.closest(place, other, SurfaceCrossing::deepest);
    if (!point || point->square < rounding * rounding) return;
    std::vector<Vec<3>>& of_other = normals[other];
    const Mesh& mesh = surfaces.type_of(other).mesh;
    if (of_other.empty()) of_other = node_normals(mesh, surfaces.nodes(other));
    Vec<3> outward = Vec<3>::Zero();
    for (std::size_t k = 0; k < 3; ++k) outward += point->weight[k] * of_other[mesh.triangles()[point->triangle][k]];
    if (point->away.dot(outward) >= 0) return;
    // Of equally deep nodes the first.
    const double depth = std::sqrt(point->square);
    const auto order = [](const SurfaceCrossing& c) { return std::tuple(-c.depth, c.cell, c.node, c.other); };
    const SurfaceCrossing found{cell, other, node, depth};
    if (!deepest || order(found) < order(*deepest)) deepest = found;
  };
  for (const int cell : surfaces.own_cells()) {
    if (!boxes[cell].usable()) continue;
    grid.find(cell, near);
    for (const int other : near) {
      // What lies inside another cell lies in its box.
      for_each_image(boxes[cell], boxes[other], 0, domain, [&](ImageShift shift) {
        if (other == cell && shift == ImageShift{}) return;
        const Vec<3> moved = moved_by(shift, domain);
        const Eigen::AlignedBox3d box(Vec<3>(boxes[other].least.data()), Vec<3>(boxes[other].most.data()));
        for (int node = surfaces.cells[cell].first; node < surfaces.cells[cell].end(); ++node) {
          const Vec<3> place =
              Vec<3>(surfaces.position[0][node], surfaces.position[1][node], surfaces.position[2][node]) - moved;
          if (box.contains(place)) look(cell, node, other, place);
        }
      });
    }
  }
  return deepest;
}

}  // namespace rouleau::core
