#include "cell_free_layer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/border.hpp"
#include "core/geometry/facet_tree.hpp"
#include "core/geometry/formulas.hpp"

namespace rouleau::observe {

namespace {

/// What a column has at each of its ends.
void narrow(CellFreeLayer& column, const CellFreeLayer& by) {
  column.lower = std::min(column.lower, by.lower);
  column.upper = std::min(column.upper, by.upper);
  column.empty = std::min(column.empty, by.empty);
}

/// The columns across y between the walls of a domain, by the node at which they stand.
class Columns {
 public:
  Columns(int count, int height)
      : upper_wall_(height - 0.5),
        columns_(static_cast<std::size_t>(count), CellFreeLayer{height / 2.0, height / 2.0}) {}

  /// A membrane between these heights; in no column (-1) where it is beyond an opening.
  void meet(int column, double y, double other) {
    if (column < 0) return;
    narrow(columns_[static_cast<std::size_t>(column)], {std::min(y, other) + 0.5, upper_wall_ - std::max(y, other), 0});
  }
  template <int D>
  [[nodiscard]] CellFreeLayer mean(const core::Ranks<D>& ranks) {
    core::join(ranks, columns_, narrow);
    const auto count = static_cast<double>(columns_.size());
    CellFreeLayer mean{0, 0, 0};
    for (const CellFreeLayer& column : columns_) {
      mean.lower += column.lower / count;
      mean.upper += column.upper / count;
      mean.empty += column.empty / count;
    }
    return mean;
  }

 private:
  double upper_wall_;
  std::vector<CellFreeLayer> columns_;
};

/// Calls visit(i) for the whole numbers from `least` to `most`. For none where they lie further apart than `longest`:
/// the last state of a run that blew up may hold anything.
template <class Visit>
void for_whole_numbers(double least, double most, double longest, Visit visit) {
  if (!(most - least < longest && std::abs(least) < 1e9)) return;
  for (double i = std::ceil(least); i <= most; ++i) visit(static_cast<int>(i));
}

/// Calls meet(i, v, w) for each whole number i at which the line from (a, va) to (b, vb) has values, from v to w: the
/// same, but for a line along which a does not change.
template <class Meet>
void at_whole_numbers(double a, double va, double b, double vb, double longest, Meet meet) {
  for_whole_numbers(std::min(a, b), std::max(a, b), longest, [&](int i) {
    const double v = b != a ? va + (vb - va) * (i - a) / (b - a) : va;
    meet(i, v, b != a ? v : vb);
  });
}

/// Calls meet(i, p, q) for each plane x = i in which a triangle of this rank's cells has a line, from p to q: (y, z). A
/// plane through a node belongs to what lies beyond it.
template <class Meet>
void for_lines_across(const core::Surfaces& surfaces, int longest, Meet meet) {
  using Place = std::array<double, 2>;
  for (const int c : surfaces.own_cells()) {
    const core::Nodes nodes = surfaces.nodes(c);
    for (const std::array<int, 3>& corners : surfaces.type_of(c).mesh.triangles()) {
      const core::Vec<3> at[] = {nodes[corners[0]], nodes[corners[1]], nodes[corners[2]]};
      const double left = std::min({at[0].x(), at[1].x(), at[2].x()}),
                   right = std::max({at[0].x(), at[1].x(), at[2].x()});
      for_whole_numbers(left, right, longest, [&](int x) {
        std::array<Place, 2> ends;
        int found = 0;
        for (int k = 0; k < 3; ++k) {
          const core::Vec<3>&from = at[k], &to = at[(k + 1) % 3];
          if ((from.x() <= x) == (to.x() <= x)) continue;
          const core::Vec<3> place = from + (to - from) * ((x - from.x()) / (to.x() - from.x()));
          ends[static_cast<std::size_t>(found++)] = {place.y(), place.z()};
        }
        if (found == 2) meet(x, ends[0], ends[1]);
      });
    }
  }
}

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

CellFreeLayer cell_free_layer(const core::Membranes& membranes, const core::Domain<2>& domain,
                              const core::Ranks<2>& ranks) {
  Columns columns(domain.size[0], domain.size[1]);
  for (const int c : membranes.own_cells()) {
    const core::CellRange& cell = membranes.cells[c];
    for (int i = cell.first; i < cell.end(); ++i) {
      const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(cell.next(i));
      at_whole_numbers(membranes.position[0][from], membranes.position[1][from], membranes.position[0][to],
                       membranes.position[1][to], domain.size[0],
                       [&](int x, double y, double other) { columns.meet(domain.wrapped(0, x), y, other); });
    }
  }
  return columns.mean(ranks);
}

CellFreeLayer cell_free_layer(const core::Surfaces& surfaces, const core::Domain<3>& domain,
                              const core::Ranks<3>& ranks) {
  Columns columns(domain.size[0] * domain.size[2], domain.size[1]);
  for_lines_across(surfaces, domain.size[0], [&](int x, const auto& p, const auto& q) {
    at_whole_numbers(p[1], p[0], q[1], q[0], domain.size[2], [&](int z, double y, double other) {
      const int column = domain.wrapped(0, x), layer = domain.wrapped(2, z);
      if (column >= 0 && layer >= 0) columns.meet(layer * domain.size[0] + column, y, other);
    });
  });
  return columns.mean(ranks);
}

CellFreeLayer cell_free_layer_in_tube(const core::Surfaces& surfaces, const core::Domain<3>& domain, double radius,
                                      const core::Ranks<3>& ranks) {
  const int half =
      std::max(1, static_cast<int>(std::ceil(std::numbers::pi * radius)));  // of the rays, half an angle off z
  const double angle = std::numbers::pi / half, axis_y = (domain.size[1] - 1) / 2.0,
               axis_z = (domain.size[2] - 1) / 2.0;
  std::vector<double> gaps(static_cast<std::size_t>(2 * half * domain.size[0]), radius);
  const auto narrow_gap = [](double& gap, double by) { gap = std::min(gap, by); };
  for_lines_across(surfaces, domain.size[0], [&](int x, const auto& p, const auto& q) {
    const double py = p[0] - axis_y, pz = p[1] - axis_z, dy = q[0] - p[0], dz = q[1] - p[1];
    const int column = domain.wrapped(0, x);
    if (!(column >= 0 && std::hypot(py, pz) < 1e9 && std::hypot(dy, dz) < 2 * radius)) return;
    // The shorter way around the axis from one end to the other; rays are numbered by their angle with z, so that the
    // upper half comes first.
    const double begin = std::atan2(py, pz);
    double end = std::atan2(py + dy, pz + dz);
    if (end - begin > std::numbers::pi) end -= 2 * std::numbers::pi;
    if (end - begin < -std::numbers::pi) end += 2 * std::numbers::pi;
    for_whole_numbers(std::min(begin, end) / angle - 0.5, std::max(begin, end) / angle - 0.5, 2 * half, [&](int ray) {
      const double toward_y = std::sin((ray + 0.5) * angle), toward_z = std::cos((ray + 0.5) * angle),
                   across = toward_z * dy - toward_y * dz;
      const double distance =
          across != 0 ? (pz * dy - py * dz) / across : std::max(std::hypot(py, pz), std::hypot(py + dy, pz + dz));
      const int number = ((ray % (2 * half)) + 2 * half) % (2 * half);
      narrow_gap(gaps[static_cast<std::size_t>(number * domain.size[0] + column)], radius - distance);
    });
  });
  core::join(ranks, gaps, narrow_gap);
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  const auto mean = [&](auto from, auto to) {
    double sum = 0;
    for (auto gap = from; gap != to; ++gap) sum += *gap;
    return sum / static_cast<double>(to - from);
  };
  const auto empty = static_cast<double>(std::count(gaps.begin(), gaps.end(), radius));
  return {mean(middle, gaps.end()), mean(gaps.begin(), middle), empty / static_cast<double>(gaps.size())};
}

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
  gaps.reserve(walls.size());
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
