#include "border.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
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
  for (auto& facet : border.facets)
    for (int& corner : facet) corner = number[corner];
}

template <int D>
class Cutter {
 public:
  Cutter(const std::vector<double>& samples, const std::array<int, D>& size) : samples_(samples), size_(size) {}

  /// What a simplex, given by its samples, adds to the border.
  void cut(const std::array<int, D + 1>& simplex) {
    std::array<int, D + 1> sorted = simplex;  // positive ones first
    const auto middle = std::stable_partition(sorted.begin(), sorted.end(), [&](int i) { return positive(i); });
    const auto inside = static_cast<int>(middle - sorted.begin()), outside = D + 1 - inside;
    if (inside == 0 || outside == 0) return;
    if (inside == 1 || outside == 1) {
      const int alone = inside == 1 ? sorted.front() : sorted.back();
      std::array<int, D> facet;
      for (int k = 0; k < D; ++k) facet[k] = corner(alone, inside == 1 ? sorted[k + 1] : sorted[k]);
      add(facet, sorted.front());
    } else if constexpr (D == 3) {  // two and two: a quadrangle
      const auto [a, b, c, d] = sorted;
      const int first = corner(a, c), second = corner(a, d), third = corner(b, d), fourth = corner(b, c);
      add({first, second, third}, a);
      add({first, third, fourth}, a);
    }
  }
  Border<D> border;

 private:
  [[nodiscard]] bool positive(int i) const { return samples_[static_cast<std::size_t>(i)] > 0; }
  [[nodiscard]] Vec<D> place_of(int sample) const {
    Vec<D> place;
    for (int k = 0; k < D; sample /= size_[k++]) place[k] = sample % size_[k];
    return place;
  }
  /// Where the edge between two samples is cut; one corner for all simplices that share it.
  int corner(int a, int b) {
    if (b < a) std::swap(a, b);
    const auto [known, is_new] = corners_.try_emplace({a, b}, static_cast<int>(border.corners.size()));
    if (is_new) {
      const double at_a = samples_[static_cast<std::size_t>(a)], at_b = samples_[static_cast<std::size_t>(b)];
      border.corners.push_back(place_of(a) + at_a / (at_a - at_b) * (place_of(b) - place_of(a)));
    }
    return known->second;
  }
  /// With the positive sample behind it, as FacetedRegion wants it; nothing where it has no size.
  void add(std::array<int, D> facet, int inside) {
    const Vec<D> normal = border.normal(facet);
    if (!(normal.norm() > 0)) return;
    if (normal.dot(place_of(inside) - border.corners[facet[0]]) > 0) std::swap(facet[0], facet[1]);
    border.facets.push_back(facet);
  }

  const std::vector<double>& samples_;
  std::array<int, D> size_;
  std::map<std::pair<int, int>, int> corners_;
};

template <int D>
class Finder {
 public:
  Finder(const Region<D>& region, const Domain<D>& domain) : region_(region), domain_(domain) {}

  /// Between samples [begin, end] along each axis, which lie where nodes do.
  void find(const Box<D>& box) {
    Vec<D> middle, half;
    int longest = 0;
    for (int k = 0; k < D; ++k) {
      middle[k] = 0.5 * (box.begin[k] + box.end[k]), half[k] = 0.5 * box.size(k);
      if (box.size(k) > box.size(longest)) longest = k;
    }
    if (std::abs(region_.distance(middle).value) > half.norm()) return;
    if (box.size(longest) <= side) return cut(box);
    Box<D> first = box, second = box;
    first.end[longest] = second.begin[longest] = box.begin[longest] + box.size(longest) / 2;
    find(first);
    find(second);
  }
  Border<D> border;

 private:
  static constexpr int side = 8;  ///< of blocks that are sampled

  void cut(const Box<D>& box) {
    Box<D> samples = box;
    std::array<int, D> size;
    Vec<D> origin;
    for (int k = 0; k < D; ++k) size[k] = box.size(k) + 1, samples.end[k] += 1, origin[k] = box.begin[k];
    std::vector<double> values;
    for (int i = 0; i < row_count(samples); ++i) {
      const std::array<int, D - 1> row = row_of(samples, i);
      Vec<D> place = origin;
      for (int k = 1; k < D; ++k) place[k] += row[k - 1];
      for (int x = 0; x < size[0]; ++x) {
        place[0] = origin[0] + x;
        values.push_back(region_.distance(place).value);
      }
    }
    const Border<D> part = zero_border<D>(values, size);
    const auto before = static_cast<int>(border.corners.size());
    for (const Vec<D>& corner : part.corners) border.corners.push_back(within(origin + corner));
    for (std::array<int, D> facet : part.facets) {
      for (int& corner : facet) corner += before;
      if (border.normal(facet).norm() > 0) border.facets.push_back(facet);
    }
  }
  /// What lies beyond the domain's own walls, or openings, half a spacing away from nodes, is put on them.
  [[nodiscard]] Vec<D> within(Vec<D> place) const {
    for (int k = 0; k < D; ++k)
      if (!domain_.periodic[k]) place[k] = std::clamp(place[k], -0.5, domain_.size[k] - 0.5);
    return place;
  }

  const Region<D>& region_;
  const Domain<D>& domain_;
};

}  // namespace

template <int D>
Border<D> border_of_region(const Region<D>& region, const Domain<D>& domain) {
  Box<D> all{{}, domain.size};
  for (int k = 0; k < D; ++k)
    if (!domain.periodic[k]) all.begin[k] = -1;
  Finder<D> finder(region, domain);
  finder.find(all);
  return std::move(finder.border);
}
template Border<2> border_of_region(const Region<2>&, const Domain<2>&);
template Border<3> border_of_region(const Region<3>&, const Domain<3>&);

template <int D>
Border<D> zero_border(const std::vector<double>& samples, const std::array<int, D>& size) {
  std::array<int, D> stride;
  int count = 1;
  for (int k = 0; k < D; ++k) stride[k] = std::exchange(count, count * size[k]);
  if (samples.size() != static_cast<std::size_t>(count)) throw std::invalid_argument("not one sample for each place");
  Cutter<D> cutter(samples, size);
  for (int i = 0; i < count; ++i) {
    bool last = false;
    for (int k = 0; k < D; ++k) last = last || i / stride[k] % size[k] + 1 == size[k];
    if (last) continue;
    std::array<int, D> axes;
    std::iota(axes.begin(), axes.end(), 0);
    do {  // a simplex for each way along the axes to the opposite corner
      std::array<int, D + 1> simplex{i};
      for (int k = 0; k < D; ++k) simplex[k + 1] = simplex[k] + stride[axes[k]];
      cutter.cut(simplex);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  return std::move(cutter.border);
}

template Border<2> zero_border<2>(const std::vector<double>&, const std::array<int, 2>&);
template Border<3> zero_border<3>(const std::vector<double>&, const std::array<int, 3>&);

template <int D>
Vec<D> Border<D>::normal(const std::array<int, D>& facet) const {
  const Vec<D> along = corners[facet[1]] - corners[facet[0]];
  if constexpr (D == 2)
    return {along[1], -along[0]};
  else
    return along.cross(corners[facet[2]] - corners[facet[0]]);
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
