// Cell-free layers at walls of any shape.
#include <algorithm>
#include <cmath>

#include "cell_free_layer.hpp"
#include "core/geometry/border_of_region.hpp"
#include "core/geometry/facet_tree.hpp"
#include "core/geometry/formulas.hpp"

namespace rouleau::observe {

template <int D>
std::vector<WallPoint<D>> wall_points(const core::RegionPointer<D>& region, const core::Domain<D>& domain) {
  constexpr std::size_t most = 10'000;
  constexpr double step = 0.5;  // into the fluid
  const core::RegionPointer<D> fluid = core::intersection<D>({region, core::between_walls<D>(domain)});
  const core::Border<D> border = core::border_of_region(*fluid, domain);
  double longest = 0;
  for (const int nodes : domain.size) longest += nodes;
  std::vector<WallPoint<D>> points;
  for (std::size_t i = 0; i < border.facets.size(); i += 1 + border.facets.size() / most) {
    const std::array<int, D>& facet = border.facets[i];
    WallPoint<D> point{core::Vec<D>::Zero(), core::size_of<D>(border, facet), step};
    for (const int corner : facet) point.place += border.corners[corner] / D;
    const core::Vec<D> inward = -border.normal(facet).normalized();
    // Corners of facets are off the wall by less than half a step.
    const auto stays_nearest = [&](double far) {
      return far < longest && fluid->distance(point.place + far * inward).value > far - step;
    };
    while (stays_nearest(point.half_width + step)) point.half_width += step;
    points.push_back(point);
  }
  return points;
}
template std::vector<WallPoint<2>> wall_points(const core::RegionPointer<2>&, const core::Domain<2>&);
template std::vector<WallPoint<3>> wall_points(const core::RegionPointer<3>&, const core::Domain<3>&);

namespace {

/// Calls visit(place) for the images of a place beside the domain, and for itself.
template <int D, class Visit>
void for_images(const core::Vec<D>& place, const core::Domain<D>& domain, Visit visit) {
  std::array<int, D> image;
  for (int k = 0; k < D; ++k) image[k] = domain.periodic[k] ? -1 : 0;
  for (;;) {
    core::Vec<D> moved = place;
    for (int k = 0; k < D; ++k) moved[k] += image[k] * domain.period(k);
    visit(moved);
    int k = 0;
    while (k < D && image[k] == (domain.periodic[k] ? 1 : 0)) image[k] = domain.periodic[k] ? -1 : 0, ++k;
    if (k == D) return;
    ++image[k];
  }
}

}  // namespace

template <int D>
CellFreeLayer cell_free_layer_at(const std::vector<WallPoint<D>>& walls, const core::CellNodes& cells,
                                 const core::Domain<D>& domain, const core::Ranks<D>& ranks) {
  std::vector<core::BoundingBox<D>> nodes;
  for (const int c : cells.own_cells()) {
    if (!core::box_of<D>(cells, c).usable()) continue;
    for (int i = cells.cells[c].first; i < cells.cells[c].end(); ++i) {
      core::BoundingBox<D>& node = nodes.emplace_back();
      for (int k = 0; k < D; ++k) {
        const double at = cells.position[k][i], period = domain.period(k);
        node.least[k] = node.most[k] = period > 0 ? at - period * std::floor(at / period) : at;
      }
    }
  }
  std::vector<double> gaps;
  for (const WallPoint<D>& wall : walls) gaps.push_back(wall.half_width);
  if (!nodes.empty()) {
    const core::FacetTree<D> tree(nodes);
    for (std::size_t w = 0; w < walls.size(); ++w) {
      double square = gaps[w] * gaps[w];
      for_images(walls[w].place, domain, [&](const core::Vec<D>& place) {
        tree.nearest(place, square, [&](int i, double least) {
          const double here = (core::Vec<D>(nodes[i].least.data()) - place).squaredNorm();
          return square = std::min(least, here);
        });
      });
      gaps[w] = std::min(gaps[w], std::sqrt(square));
    }
  }
  core::join(ranks, gaps, [](double& gap, double by) { gap = std::min(gap, by); });
  double sum = 0, empty = 0, all = 0;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    all += walls[w].size;
    sum += walls[w].size * gaps[w];
    if (gaps[w] == walls[w].half_width) empty += walls[w].size;
  }
  return {sum / all, sum / all, empty / all};
}
template CellFreeLayer cell_free_layer_at(const std::vector<WallPoint<2>>&, const core::CellNodes&,
                                          const core::Domain<2>&, const core::Ranks<2>&);
template CellFreeLayer cell_free_layer_at(const std::vector<WallPoint<3>>&, const core::CellNodes&,
                                          const core::Domain<3>&, const core::Ranks<3>&);

}  // namespace rouleau::observe
