#include "faceted.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "triangle_distance.hpp"

namespace rouleau::core {

namespace {

template <int D>
std::vector<BoundingBox<D>> boxes_around(const std::vector<Vec<D>>& corners,
                                         const std::vector<std::array<int, D>>& facets) {
  std::vector<BoundingBox<D>> boxes;
  for (const auto& facet : facets) {
    BoundingBox<D>& box = boxes.emplace_back();
    for (int k = 0; k < D; ++k) {
      const auto [least, most] =
          std::ranges::minmax(facet, {}, [&](int corner) { return corners.at(static_cast<std::size_t>(corner))[k]; });
      box.least[k] = corners[least][k], box.most[k] = corners[most][k];
    }
  }
  if (boxes.empty()) throw std::invalid_argument("a border without facets");
  return boxes;
}

}  // namespace

/// Where a facet is nearest to a place.
template <int D>
struct FacetedRegion<D>::Nearest {
  std::array<double, D> weight;  ///< of the corners; 0: the place lies beyond
  Vec<D> away;                   ///< from there to the place
};

template <int D>
FacetedRegion<D>::FacetedRegion(std::vector<Vec<D>> corners, std::vector<Facet> facets)
    : corners_(std::move(corners)), facets_(std::move(facets)), tree_(boxes_around<D>(corners_, facets_)) {
  for (const Facet& facet : facets_) {
    const Vec<D> along = corners_[facet[1]] - corners_[facet[0]];
    Vec<D> normal;
    if constexpr (D == 2) {
      normal = {along[1], -along[0]};
    } else {
      normal = along.cross(corners_[facet[2]] - corners_[facet[0]]);
    }
    const double size = normal.norm();
    if (!(size > 0)) throw std::invalid_argument("facet " + std::to_string(normals_.size()) + " has no size");
    normals_.push_back(normal / size);
  }
  add_normals();
}

template <int D>
void FacetedRegion<D>::add_normals() {
  corner_normals_.resize(corners_.size(), Vec<D>::Zero());
  std::map<std::pair<int, int>, Vec<D>> of_edges;
  const auto edge = [](int a, int b) { return std::pair(std::min(a, b), std::max(a, b)); };
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    for (int k = 0; k < D; ++k) {
      const int corner = facets_[i][k], next = facets_[i][(k + 1) % D], last = facets_[i][(k + D - 1) % D];
      double angle = 1;
      if constexpr (D == 3) {
        const Vec<D> to_next = corners_[next] - corners_[corner], to_last = corners_[last] - corners_[corner];
        angle = std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
        of_edges.try_emplace(edge(next, last), Vec<D>::Zero()).first->second += normals_[i];
      }
      corner_normals_[corner] += angle * normals_[i];
    }
  }
  if constexpr (D == 3) {
    for (const Facet& facet : facets_) {
      auto& normals = edge_normals_.emplace_back();
      for (int k = 0; k < D; ++k) normals[k] = of_edges.at(edge(facet[(k + 1) % D], facet[(k + 2) % D]));
    }
  }
}

template <int D>
auto FacetedRegion<D>::nearest_of(const Facet& facet, const Vec<D>& place) const -> Nearest {
  if constexpr (D == 2) {
    const Vec<D> from = place - corners_[facet[0]], along = corners_[facet[1]] - corners_[facet[0]];
    const double share = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
    return {{1 - share, share}, from - share * along};
  } else {
    const auto vector = [](const Vec<D>& v) { return Vectors<double>{v[0], v[1], v[2]}; };
    const auto found = closest_point(vector(place), vector(corners_[facet[0]]), vector(corners_[facet[1]]),
                                     vector(corners_[facet[2]]));
    return {{found.weight[0], found.weight[1], found.weight[2]}, {found.away.x, found.away.y, found.away.z}};
  }
}

template <int D>
Distance<D> FacetedRegion<D>::distance(const Vec<D>& place) const {
  int facet = -1;
  Nearest nearest{};
  double least = std::numeric_limits<double>::infinity();
  tree_.nearest(place, least, [&](int i, double) {
    const Nearest found = nearest_of(facets_[i], place);
    // Of facets that are as near the first one counts, in whichever order they come.
    const double square = found.away.squaredNorm();
    if (square < least || (square == least && i < facet)) least = square, facet = i, nearest = found;
    return least;
  });
  const auto beyond = [&](int k) { return nearest.weight[k] == 0; };
  Vec<D> normal = normals_[facet];
  for (int k = 0; k < D; ++k) {
    if (beyond((k + 1) % D) && beyond((k + D - 1) % D)) {
      normal = corner_normals_[facets_[facet][k]];
    } else if (D == 3 && beyond(k) && !beyond((k + 1) % D) && !beyond((k + 2) % D)) {
      normal = edge_normals_[facet][k];
    }
  }
  const double away = std::sqrt(least), sign = normal.dot(nearest.away) > 0 ? -1 : 1;
  // On the border its normal is all there is.
  constexpr double on_border = 1e-12;
  return {sign * away, away > on_border ? Vec<D>(sign * nearest.away / away) : Vec<D>(-normal.normalized())};
}

template class FacetedRegion<2>;
template class FacetedRegion<3>;

}  // namespace rouleau::core
