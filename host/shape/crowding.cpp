#include "crowding.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/contact/cell_grid.hpp"
#include "outline.hpp"
#include "scene/lattice.hpp"

namespace rouleau::shape {

namespace {

/// Radius of the largest circle around the centre of a cell that lies within its outline; 0: it is a surface.
double inner_radius(const scene::CellType& type) {
  if (type.segments == 0) return 0;
  const auto nodes = make_outline(type.shape, type.segments).nodes;
  double least = nodes.front().norm();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Vector2d& from = nodes[i];
    const Eigen::Vector2d along = nodes[(i + 1) % nodes.size()] - from;
    const double share = std::clamp(-from.dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (from + share * along).norm());
  }
  return least;
}

/// Between the nearest of all images of two places.
double distance_between(const scene::Vector& a, const scene::Vector& b, const scene::Domain& domain) {
  scene::Vector apart = a - b;
  for (int axis = 0; axis < domain.dimension(); ++axis) {
    const double size = domain.size[axis];
    if (domain.periodic[axis]) apart[axis] -= size * std::round(apart[axis] / size);
  }
  return apart.norm();
}

}  // namespace

std::optional<CrowdedPair> find_crowded_pair(const scene::Scene& scene) {
  std::vector<double> radius;  // of each type
  for (const scene::CellType& type : scene.cell_types) radius.push_back(inner_radius(type));
  if (std::none_of(radius.begin(), radius.end(), [](double of_type) { return of_type > 0; })) return {};
  const double spacing = scene::lattice_spacing(scene);
  std::vector<core::BoundingBox<2>> circles;
  circles.reserve(scene.cells.size());
  for (const scene::CellPlacement& cell : scene.cells) {
    const double x = cell.center.x() / spacing, y = cell.center.y() / spacing, r = radius[cell.type] / spacing;
    circles.push_back({{x - r, y - r}, {x + r, y + r}});
  }
  const core::CellGrid<2> grid(circles, 0, scene::lattice_domain(scene));
  std::vector<int> near;
  for (int cell = 0; cell < static_cast<int>(circles.size()); ++cell) {
    const scene::CellPlacement& one = scene.cells[cell];
    grid.find(cell, near);
    for (const int other : near) {
      const scene::CellPlacement& two = scene.cells[other];
      const double distance = distance_between(one.center, two.center, scene.domain);
      if (other != cell && distance < radius[one.type] + radius[two.type])
        return CrowdedPair{std::min(cell, other), std::max(cell, other), distance};
    }
  }
  return {};
}

namespace {
constexpr int items_of_ball = 4;  ///< of a tree's smallest balls
}

BallTree::BallTree(const std::vector<Place<3>>& centers, const std::vector<double>& radii) : order_(centers.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  add(centers, radii, 0, static_cast<int>(order_.size()));
}

void BallTree::add(const std::vector<Place<3>>& centers, const std::vector<double>& radii, int first, int end) {
  Place<3> least = centers[order_[first]], most = least;
  for (int i = first; i < end; ++i) {
    for (int k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], centers[order_[i]][k]);
      most[k] = std::max(most[k], centers[order_[i]][k]);
    }
  }
  Ball ball{{}, 0, first, end, 0};
  for (int k = 0; k < 3; ++k) ball.center[k] = 0.5 * (least[k] + most[k]);
  for (int i = first; i < end; ++i) {
    const int item = order_[i];
    ball.radius = std::max(ball.radius, norm(minus(centers[item], ball.center)) + radii[item]);
  }
  const bool whole = end - first <= items_of_ball;
  if (!whole) ball.end = first;
  const std::size_t place = balls_.size();
  balls_.push_back(ball);
  if (!whole) {
    const Place<3> width = minus(most, least);
    const auto axis = std::max_element(width.begin(), width.end()) - width.begin();
    std::sort(order_.begin() + first, order_.begin() + end,
              [&](int a, int b) { return std::pair(centers[a][axis], a) < std::pair(centers[b][axis], b); });
    const int middle = first + (end - first) / 2;
    add(centers, radii, first, middle);
    add(centers, radii, middle, end);
  }
  balls_[place].next = balls_.size();
}

}  // namespace rouleau::shape
