#include "zero_border.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace rouleau::core {

namespace {

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

}  // namespace

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

}  // namespace rouleau::core
