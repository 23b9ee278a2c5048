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
std::vector<BoundingBox<D>> boxes_around(const Border<D>& border) {
  std::vector<BoundingBox<D>> boxes;
  for (const auto& facet : border.facets) {
    BoundingBox<D>& box = boxes.emplace_back();
    for (int k = 0; k < D; ++k) {
      const auto [least, most] = std::ranges::minmax(facet, {}, [&](int corner) { return border.corners[corner][k]; });
      box.least[k] = border.corners[least][k], box.most[k] = border.corners[most][k];
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
FacetedRegion<D>::FacetedRegion(Border<D> border) : border_(std::move(border)), tree_(boxes_around<D>(border_)) {
  for (const Facet& facet : border_.facets) {
    const Vec<D> normal = border_.normal(facet);
    if (!(normal.norm() > 0)) throw std::invalid_argument("facet " + std::to_string(normals_.size()) + " has no size");
    normals_.push_back(normal.normalized());
  }
  add_normals();
}

template <int D>
void FacetedRegion<D>::add_normals() {
  corner_normals_.resize(border_.corners.size(), Vec<D>::Zero());
  std::map<std::pair<int, int>, Vec<D>> of_edges;
  const auto edge = [](int a, int b) { return std::pair(std::min(a, b), std::max(a, b)); };
  for (std::size_t i = 0; i < border_.facets.size(); ++i) {
    for (int k = 0; k < D; ++k) {
      const int corner = border_.facets[i][k], next = border_.facets[i][(k + 1) % D],
                last = border_.facets[i][(k + D - 1) % D];
      double angle = 1;
      if constexpr (D == 3) {
        const Vec<D> to_next = border_.corners[next] - border_.corners[corner],
                     to_last = border_.corners[last] - border_.corners[corner];
        angle = std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
        of_edges.try_emplace(edge(next, last), Vec<D>::Zero()).first->second += normals_[i];
      }
      corner_normals_[corner] += angle * normals_[i];
    }
  }
  if constexpr (D == 3) {
    for (const Facet& facet : border_.facets) {
      auto& normals = edge_normals_.emplace_back();
      for (int k = 0; k < D; ++k) normals[k] = of_edges.at(edge(facet[(k + 1) % D], facet[(k + 2) % D]));
    }
  }
}

template <int D>
auto FacetedRegion<D>::nearest_of(const Facet& facet, const Vec<D>& place) const -> Nearest {
  if constexpr (D == 2) {
    const Vec<D> from = place - border_.corners[facet[0]],
                 along = border_.corners[facet[1]] - border_.corners[facet[0]];
    const double share = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
    return {{1 - share, share}, from - share * along};
  } else {
    const auto vector = [](const Vec<D>& v) { return Vectors<double>{v[0], v[1], v[2]}; };
    const auto found = closest_point(vector(place), vector(border_.corners[facet[0]]),
                                     vector(border_.corners[facet[1]]), vector(border_.corners[facet[2]]));
    return {{found.weight[0], found.weight[1], found.weight[2]}, {found.away.x, found.away.y, found.away.z}};
  }
}

template <int D>
Distance<D> FacetedRegion<D>::distance(const Vec<D>& place) const {
  int facet = -1;
  Nearest nearest{};
  double least = std::numeric_limits<double>::infinity();
  tree_.nearest(place, least, [&](int i, double) {
    const Nearest found = nearest_of(border_.facets[i], place);
    // Of facets that are as near the first one counts, in whichever order they come.
    const double square = found.away.squaredNorm();
    if (square < least || (square == least && i < facet)) least = square, facet = i, nearest = found;
    return least;
  });
  const auto beyond = [&](int k) { return nearest.weight[k] == 0; };
  Vec<D> normal = normals_[facet];
  for (int k = 0; k < D; ++k)
    if (beyond((k + 1) % D) && beyond((k + D - 1) % D))
      normal = corner_normals_[border_.facets[facet][k]];
    else if (D == 3 && beyond(k) && !beyond((k + 1) % D) && !beyond((k + 2) % D))
      normal = edge_normals_[facet][k];
  const double away = std::sqrt(least), sign = normal.dot(nearest.away) > 0 ? -1 : 1;
  // On the border its normal is all there is.
  constexpr double on_border = 1e-12;
  return {sign * away, away > on_border ? Vec<D>(sign * nearest.away / away) : Vec<D>(-normal.normalized())};
}

template class FacetedRegion<2>;
template class FacetedRegion<3>;

}  // namespace rouleau::core
