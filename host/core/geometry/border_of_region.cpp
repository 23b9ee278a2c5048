#include "border_of_region.hpp"

#include <algorithm>
#include <cmath>

#include "zero_border.hpp"

namespace rouleau::core {

namespace {

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
    for (int k = 0; k < D; ++k) {
      if (!domain_.periodic[k]) place[k] = std::clamp(place[k], -0.5, domain_.size[k] - 0.5);
    }
    return place;
  }

  const Region<D>& region_;
  const Domain<D>& domain_;
};

}  // namespace

template <int D>
Border<D> border_of_region(const Region<D>& region, const Domain<D>& domain) {
  Box<D> all{{}, domain.size};
  for (int k = 0; k < D; ++k) {
    if (!domain.periodic[k]) all.begin[k] = -1;
  }
  Finder<D> finder(region, domain);
  finder.find(all);
  return std::move(finder.border);
}
template Border<2> border_of_region(const Region<2>&, const Domain<2>&);
template Border<3> border_of_region(const Region<3>&, const Domain<3>&);

}  // namespace rouleau::core
