#include "crossing.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "cell_grid.hpp"
#include "core/membrane/geometry.hpp"
#include "surface_patches.hpp"

namespace rouleau::core {

namespace {

struct Segment {
  int node, next;  // indices in Membranes
  Vec<2> from, to;
  [[nodiscard]] double x_min() const { return std::min(from.x(), to.x()); }
  [[nodiscard]] double x_max() const { return std::max(from.x(), to.x()); }
};

/// Segments of a cell, moved, that touch a box; in order of their left ends.
void collect(const Membranes& membranes, const CellRange& cell, const Vec<2>& move, const BoundingBox<2>& box,
             std::vector<Segment>& segments) {
  segments.clear();
  const auto node = [&](int i) -> Vec<2> { return Vec<2>(membranes.position[0][i], membranes.position[1][i]) + move; };
  for (int i = cell.first; i < cell.end(); ++i) {
    const int next = cell.next(i);
    const Segment segment{i, next, node(i), node(next)};
    if (segment.x_min() > box.most[0] || segment.x_max() < box.least[0]) continue;
    if (std::min(segment.from.y(), segment.to.y()) > box.most[1] ||
        std::max(segment.from.y(), segment.to.y()) < box.least[1])
      continue;
    segments.push_back(segment);
  }
  std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) { return a.x_min() < b.x_min(); });
}

/// Where two segments cross. A point exactly on the other segment's line counts as outside of it, so that outlines that
/// only touch from outside do not cross, and a crossing through a node is still found once.
std::optional<Vec<2>> intersection(const Segment& a, const Segment& b) {
  const Vec<2> u = a.to - a.from, v = b.to - b.from;
  const double b_from = core::cross(u, b.from - a.from), b_to = core::cross(u, b.to - a.from);
  if ((b_from > 0) == (b_to > 0)) return std::nullopt;
  const double a_from = core::cross(v, a.from - b.from), a_to = core::cross(v, a.to - b.from);
  if ((a_from > 0) == (a_to > 0)) return std::nullopt;
  return Vec<2>(a.from + a_from / (a_from - a_to) * u);
}

struct Found {
  int node;
  Vec<2> place;
};

/// First crossing between two lists sorted by their left ends; `same`: both are the same list of one cell.
std::optional<Found> sweep(const std::vector<Segment>& as, const std::vector<Segment>& bs, bool same) {
  std::size_t begin = 0;
  double widest = 0;
  for (const Segment& b : bs) widest = std::max(widest, b.x_max() - b.x_min());
  for (const Segment& a : as) {
    while (begin < bs.size() && bs[begin].x_min() + widest < a.x_min()) ++begin;
    for (std::size_t k = begin; k < bs.size() && bs[k].x_min() <= a.x_max(); ++k) {
      const Segment& b = bs[k];
      if (same && (b.node <= a.node || b.node == a.next || b.next == a.node)) continue;
      if (const auto place = intersection(a, b)) return Found{a.node, *place};
    }
  }
  return std::nullopt;
}

bool contains(const BoundingBox<2>& outer, const BoundingBox<2>& inner) {
  return outer.least[0] <= inner.least[0] && inner.most[0] <= outer.most[0] && outer.least[1] <= inner.least[1] &&
         inner.most[1] <= outer.most[1];
}

/// Looks at one pair of cells and one image of the second.
class PairCheck {
 public:
  PairCheck(const Membranes& membranes, const Domain<2>& domain) : membranes_(membranes), domain_(domain) {}

  std::optional<Crossing> operator()(int a, int b, ImageShift shift) {
    const CellRange& cell = membranes_.cells[a];
    const CellRange& other = membranes_.cells[b];
    const Vec<2> move = moved_by(shift, domain_);
    const BoundingBox<2> own = box_of<2>(membranes_, cell);
    BoundingBox<2> moved = box_of<2>(membranes_, other), common;
    for (int k = 0; k < 2; ++k) {
      moved.least[k] += move[k], moved.most[k] += move[k];
      common.least[k] = std::max(own.least[k], moved.least[k]), common.most[k] = std::min(own.most[k], moved.most[k]);
    }
    const bool same = a == b && shift == ImageShift{};
    collect(membranes_, cell, Vec<2>::Zero(), common, own_);
    if (!same) collect(membranes_, other, move, common, other_);
    if (const auto found = sweep(own_, same ? own_ : other_, same))
      return Crossing{a, b, shift, found->node, found->place, false};
    if (same) return std::nullopt;
    if (contains(moved, own)) {
      const Vec<2> node = first_node(cell);
      if (core::depth_inside(membranes_, other, node - move) > 0) return Crossing{a, b, shift, cell.first, node, true};
    }
    if (contains(own, moved)) {
      const Vec<2> node = first_node(other);
      if (core::depth_inside(membranes_, cell, node + move) > 0) return Crossing{b, a, -shift, other.first, node, true};
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Vec<2> first_node(const CellRange& cell) const {
    return {membranes_.position[0][cell.first], membranes_.position[1][cell.first]};
  }
  const Membranes& membranes_;
  const Domain<2>& domain_;
  std::vector<Segment> own_, other_;
};

}  // namespace

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

std::optional<Crossing> find_crossing(const Membranes& membranes, const Domain<2>& domain) {
  const std::vector<BoundingBox<2>> extent = boxes_of_known<2>(membranes);
  PairCheck check(membranes, domain);
  std::optional<Crossing> found;
  const CellGrid<2> grid(extent, 0.0, domain);
  std::vector<int> near;
  for (const int a : membranes.own_cells()) {
    if (found) break;
    grid.find(a, near);
    std::sort(near.begin(), near.end());  // the crossing that is found first does not depend on the grid
    for (const int b : near) {
      if (b < a || found) continue;
      core::for_each_image(extent[a], extent[b], 0.0, domain, [&](ImageShift shift) {
        // Of a cell's own images, one of two opposite ones is enough.
        if (found || (a == b && (shift.x < 0 || (shift.x == 0 && shift.y < 0)))) return;
        found = check(a, b, shift);
      });
    }
  }
  return found;
}

}  // namespace rouleau::core
