#include "near_border.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace rouleau::core {

template <int D>
NearBorder<D>::NearBorder(RegionPointer<D> region, const Domain<D>& domain, double reach)
    : region_(std::move(region)), domain_(domain), reach_(reach) {
  std::size_t all = 1;
  int most = 1;
  for (int k = 0; k < D; ++k) {
    count_[k] = static_cast<int>((domain.size[k] + 1) / edge) + 1;
    all *= static_cast<std::size_t>(count_[k]);
    most = std::max(most, count_[k]);
  }
  near_.resize(all);
  mark({}, static_cast<int>(std::bit_ceil(static_cast<unsigned>(most))));
}

template <int D>
std::size_t NearBorder<D>::number(const std::array<int, D>& box) const {
  std::size_t number = 0;
  for (int k = D - 1; k >= 0; --k)
    number = number * static_cast<std::size_t>(count_[k]) + static_cast<std::size_t>(box[k]);
  return number;
}

template <int D>
void NearBorder<D>::mark(const std::array<int, D>& first, int boxes) {
  Vec<D> middle;
  for (int k = 0; k < D; ++k) {
    if (first[k] >= count_[k]) return;
    middle[k] = edge * (first[k] + boxes / 2.0) - 1;
  }
  // No distance changes faster than its place; a little more for what is rounded.
  const double half_diagonal = edge * boxes / 2 * std::sqrt(D) * (1 + 1e-9) + 1e-9;
  if (region_->distance(middle).value - half_diagonal > reach_) return;
  if (boxes == 1) {
    near_[number(first)] = true;
    return;
  }
  for (int half = 0; half < 1 << D; ++half) {
    std::array<int, D> begin = first;
    for (int k = 0; k < D; ++k) begin[k] += (half >> k & 1) * boxes / 2;
    mark(begin, boxes / 2);
  }
}

template <int D>
std::optional<Distance<D>> NearBorder<D>::at(Vec<D> place) const {
  constexpr double far = 1e9;
  std::array<int, D> box;
  bool inside = true;
  for (int k = 0; k < D; ++k) {
    if (!(std::abs(place[k]) < far)) return std::nullopt;
    if (const double period = domain_.period(k); period > 0) place[k] -= period * std::floor(place[k] / period);
    box[k] = static_cast<int>(std::floor((place[k] + 1) / edge));
    inside = inside && box[k] >= 0 && box[k] < count_[k];
  }
  if (inside && !near_[number(box)]) return std::nullopt;
  return region_->distance(place);
}

template class NearBorder<2>;
template class NearBorder<3>;

}  // namespace rouleau::core
