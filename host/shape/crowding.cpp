#include "crowding.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "outline.hpp"

namespace rouleau::shape {

namespace {

/// Radius of the largest circle around the centre of a cell that lies within its outline.
double inner_radius(const scene::CellType& type) {
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

/// A cell by the bin that its centre lies in. Bins are as wide as two of the largest circles, so that cells whose
/// circles overlap lie in the same bin or in neighbours.
struct Binned {
  long column, row;
  int cell;
  [[nodiscard]] std::tuple<long, long, int> order() const { return {column, row, cell}; }
};

class Bins {
 public:
  explicit Bins(const scene::Scene& scene) : scene_(scene) {
    for (const scene::CellType& type : scene.cell_types) radius_.push_back(inner_radius(type));
    const double width = 2 * *std::max_element(radius_.begin(), radius_.end());
    for (const int axis : {0, 1}) {
      count_[axis] = std::max(1L, static_cast<long>(scene.domain.size[axis] / width));
      width_[axis] = is_periodic(axis) ? scene.domain.size[axis] / static_cast<double>(count_[axis]) : width;
    }
    binned_.reserve(scene.cells.size());
    for (std::size_t i = 0; i < scene.cells.size(); ++i) {
      const scene::Vector& center = scene.cells[i].center;
      binned_.push_back({bin(0, center.x()), bin(1, center.y()), static_cast<int>(i)});
    }
    std::sort(binned_.begin(), binned_.end(), [](const auto& a, const auto& b) { return a.order() < b.order(); });
  }

  [[nodiscard]] std::optional<CrowdedPair> find_pair() const {
    for (const Binned& one : binned_) {
      for (long column = one.column - 1; column <= one.column + 1; ++column) {
        for (long row = one.row - 1; row <= one.row + 1; ++row) {
          if (const auto pair = pair_in(one.cell, wrapped(0, column), wrapped(1, row))) return pair;
        }
      }
    }
    return {};
  }

 private:
  [[nodiscard]] bool is_periodic(int axis) const { return scene_.domain.periodic[axis]; }
  [[nodiscard]] long wrapped(int axis, long bin) const {
    return is_periodic(axis) ? (bin % count_[axis] + count_[axis]) % count_[axis] : bin;
  }
  [[nodiscard]] long bin(int axis, double place) const {
    return wrapped(axis, static_cast<long>(std::floor(place / width_[axis])));
  }

  [[nodiscard]] std::optional<CrowdedPair> pair_in(int cell, long column, long row) const {
    const Binned first{column, row, 0};
    auto at = std::lower_bound(binned_.begin(), binned_.end(), first,
                               [](const auto& a, const auto& b) { return a.order() < b.order(); });
    for (; at != binned_.end() && at->column == column && at->row == row; ++at) {
      if (at->cell == cell) continue;
      const double distance = distance_between(cell, at->cell);
      const double room = radius_[scene_.cells[cell].type] + radius_[scene_.cells[at->cell].type];
      if (distance < room) return CrowdedPair{std::min(cell, at->cell), std::max(cell, at->cell), distance};
    }
    return {};
  }

  [[nodiscard]] double distance_between(int a, int b) const {
    scene::Vector apart = scene_.cells[a].center - scene_.cells[b].center;
    for (const int axis : {0, 1}) {
      const double size = scene_.domain.size[axis];
      if (is_periodic(axis)) apart[axis] -= size * std::round(apart[axis] / size);
    }
    return apart.norm();
  }

  const scene::Scene& scene_;
  std::vector<double> radius_;  ///< of each type
  long count_[2];               ///< bins along a periodic axis
  double width_[2];
  std::vector<Binned> binned_;
};

}  // namespace

std::optional<CrowdedPair> find_crowded_pair(const scene::Scene& scene) {
  if (scene.cells.empty()) return {};
  return Bins(scene).find_pair();
}

}  // namespace rouleau::shape
