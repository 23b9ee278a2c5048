#include "border.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace rouleau::core {

namespace {

constexpr double joined = 1e-6;  // corners this share of a period apart are one; so are ends of the domain

/// Joins corners that are no farther apart than a distance along any axis: each is looked for in the cells around it.
template <int D>
void weld(Border<D>& border, double distance) {
  std::map<std::array<long, D>, int> at;
  std::vector<int> number;
  std::vector<Vec<D>> corners;
  for (const Vec<D>& corner : border.corners) {
    const auto cell = [&](const Vec<D>& place) {
      std::array<long, D> of;
      for (int k = 0; k < D; ++k) of[k] = std::lround(std::floor(place[k] / (4 * distance)));
      return of;
    };
    int found = -1;
    for (int i = 0; i < (1 << D) && found < 0; ++i) {
      Vec<D> aside = corner;
      for (int k = 0; k < D; ++k) aside[k] += (i >> k & 1) != 0 ? distance : -distance;
      if (const auto known = at.find(cell(aside)); known != at.end()) found = known->second;
    }
    if (found < 0) {
      found = at[cell(corner)] = static_cast<int>(corners.size());
      corners.push_back(corner);
    }
    number.push_back(found);
  }
  border.corners = std::move(corners);
  for (auto& facet : border.facets) {
    for (int& corner : facet) corner = number[corner];
  }
}

}  // namespace

template <int D>
Vec<D> Border<D>::normal(const std::array<int, D>& facet) const {
  const Vec<D> along = corners[facet[1]] - corners[facet[0]];
  if constexpr (D == 2) {
    return {along[1], -along[0]};
  } else {
    return along.cross(corners[facet[2]] - corners[facet[0]]);
  }
}

template <int D>
Border<D> with_images(Border<D> border, const Domain<D>& domain) {
  double welded = 0;
  for (int k = 0; k < D; ++k) {
    const double period = domain.period(k), first = -0.5 + joined * period, last = period - 0.5 - joined * period;
    if (period == 0 || border.corners.empty()) continue;
    const auto along = [k](const Vec<D>& corner) { return corner[k]; };
    const auto [least, most] = std::ranges::minmax(border.corners, {}, along);
    if (least[k] <= first && most[k] >= last) {
      std::erase_if(border.facets, [&](const auto& facet) {
        const auto at = [&](int corner) { return border.corners[corner][k]; };
        return std::ranges::all_of(facet, [&](int corner) { return at(corner) <= first; }) ||
               std::ranges::all_of(facet, [&](int corner) { return at(corner) >= last; });
      });
    }
    const Border<D> own = border;
    for (const int sign : {-1, 1}) {
      const int before = static_cast<int>(border.corners.size());
      for (const Vec<D>& corner : own.corners) border.corners.push_back(corner + sign * period * Vec<D>::Unit(k));
      for (auto facet : own.facets) {
        for (int& corner : facet) corner += before;
        border.facets.push_back(facet);
      }
    }
    welded = std::max(welded, joined * period);
  }
  if (welded > 0) weld(border, welded);
  return border;
}

template <int D>
std::vector<Vec<D>> open_sides(const Border<D>& border) {
  std::map<std::array<int, D - 1>, std::pair<int, int>> sides;  // how many run one way, and the other
  for (const auto& facet : border.facets) {
    if constexpr (D == 2) {
      ++sides[{facet[0]}].first, ++sides[{facet[1]}].second;
    } else {
      for (int k = 0; k < D; ++k) {
        const int a = facet[k], b = facet[(k + 1) % D];
        auto& [up, down] = sides[{std::min(a, b), std::max(a, b)}];
        ++(a < b ? up : down);
      }
    }
  }
  std::vector<Vec<D>> open;
  for (const auto& [side, counts] : sides) {
    if (counts == std::pair(1, 1)) continue;
    Vec<D> middle = Vec<D>::Zero();
    for (const int corner : side) middle += border.corners[corner] / (D - 1);
    open.push_back(middle);
  }
  return open;
}

template struct Border<2>;
template struct Border<3>;
template Border<2> with_images(Border<2>, const Domain<2>&);
template Border<3> with_images(Border<3>, const Domain<3>&);
template std::vector<Vec<2>> open_sides(const Border<2>&);
template std::vector<Vec<3>> open_sides(const Border<3>&);

}  // namespace rouleau::core
